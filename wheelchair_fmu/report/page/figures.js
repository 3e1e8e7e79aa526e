// Every figure of the page: what it is called, how it is drawn, what its caption and its table say.

import { byId, h } from "page/dom";
import { canvas, svg } from "page/draw";
import { byChannel, excessBy } from "page/errors";
import { Figure } from "page/figure";
import { fitting, forest, panels } from "page/forest";
import { following } from "page/following";
import { Heat, QUIET, heat } from "page/heat";
import { crossings, profiles, stays, together } from "page/landscape";
import { labelled, lines, path } from "page/lines";
import { against, drawn as drawnAgainst } from "page/regimes";
import { UNSEEN, beside, between, chance, degrees, display, endsOf, inUnit, rms, significant, uncertain, unitText, withError, withInterval } from "page/numbers";
import { staircase } from "page/staircase";
import { capital, channelOf, isolated, listed, proposed, rankedOf, runOf, shortOf, stepOf, stillOf, titleOf } from "page/words";

const FIRST = 12; // effects in the forest plot
const LOW = 230; // px: height of curves below which no error stands under them, as its label has no room
const AXES = 92; // px: what curves have above, between and below them
const ADDS_UP = ["x", "y", "yaw"]; // channels in which noise of the pushes adds up
const WHEELS = { rl: "left rear wheel", rr: "right rear wheel", fl: "left caster", fr: "right caster" };
const OF_THE_BODY = { "rider.s": "the body’s motion forward [m]", "rider.momentum": "the body’s momentum [N.s]", "stroke.phase": "strokes since the first" };
const LATE = 10; // samples from the end of a run

/** Are there heights of a likelihood enough to see how it rises from the estimate? Where a search stopped at the bounds of other values it
 *  rises at once, and a picture of it would say nothing of how sure a size is. */
const bowl = (heights, level) => heights.filter((v) => v !== null && v < 2 * level).length > 3;

/** Columns of a table by their heads, of rows that have them by `heads`' names. */
const tabled = (rows, heads) => Object.fromEntries(Object.entries(heads).map(([name, head]) => [head, rows.map((r) => r[name])]));

/** What ± is, where a number has it in place of an interval. */
const plainly = (rows) => (rows.some((r) => r.plainly) ? " Where a number has a ±, the bar reaches twice as far either way, as far as bounds let it." : "");

export class Figures {
  /** `app` has shown, results, now, before(), timeline and motion. */
  constructor(campaign, app) {
    Object.assign(this, { campaign, app, ladder: campaign.diagnosis.ladder.map((s) => ({ ...s, name: stepOf(campaign, s.step) })) });
    this.all = {};
    this.add("staircase", "The error falling, step by step", this.stairs());
    this.add("forest", "Sizes of effects, with their 95 % intervals", this.sizes());
    if (campaign.diagnosis.calibration && Object.keys(campaign.diagnosis.calibration).length) this.add("calibration", "Calibrated values beside what was given", this.calibrated());
    else byId("calibration").remove();
    if (this.ladder.some((s) => s.channels)) this.add("physical", "The error in the sensors' own units", this.units());
    else byId("physical").remove(); // an older diagnosis
    this.landscape();
    const next = following(campaign, () => this.whole());
    if (next) byId("ties").append(h("figure", { id: "next" })), this.add("next", next.title, next);
    const missing = campaign.diagnosis.missing;
    byId("missing").hidden = !missing;
    if (missing) this.add("missing", `What is missing: ${missing.words}`, this.lacking(missing));
  }

  add(id, title, says, own = false) {
    const { campaign } = this;
    this.all[id] = new Figure(byId(id), { title, subject: () => this.whole(), file: () => `${campaign.name}-${id}`, ...says }, own);
    if (!own) this.all[id].redraw();
    return this.all[id];
  }

  /** What figures of the whole campaign are of. */
  whole() {
    const { name, runs } = this.campaign, held = runs.filter((r) => r.role === "holdout").length;
    return `${isolated(name)}, ${runs.length === 1 ? "one run" : `${runs.length} runs`}${held ? `, ${held} of them held out` : ""}`;
  }

  /** Those that need the model. */
  alive() {
    const { campaign, app } = this, subject = () => `${isolated(campaign.name)}, ${runOf(campaign.runs[app.shown.run])}, ${app.called()}`, file = (id) => () => `${campaign.name}-${campaign.runs[app.shown.run].name}-${id}`;
    this.add("path", "The chair from above", { ...this.above(), subject, file: file("path") }, true);
    this.add("overlay", "Measured and model", { ...this.curves(), subject, file: file("curves") }, true);
    const of = () => `${this.whole()}, ${app.called()}`;
    this.add("where", "Where the error is", { ...this.places(), subject: of }, true);
    this.add("regimes", "The error against what was going on", { ...this.moments(), subject: of });
    this.heatWhere = new Heat(this.all.where.drawing, "Error by run and channel, noise = 1; arrow keys go from cell to cell", campaign.channels.map((c) => channelOf(c.name)), ([run, channel]) => app.show(run, channel));
  }

  stairs() {
    const steps = () => (this.app.now && this.apart() ? [...this.ladder, { name: "as set now", ...this.app.now }] : this.ladder);
    return {
      draw: (width, look) => staircase(width, look, this.ladder, this.apart() ? this.app.now : null),
      columns: () => ({ step: steps().map((s) => s.name), "held-out runs": steps().map((s) => s.heldout), "fitted runs": steps().map((s) => s.fit) }),
      caption: () => `Error over all channels, in units of what sensor noise alone gives: ${steps().map((s) => `${stillOf(s.name)} ${rms(s.heldout ?? s.fit)}`).join(", ")}${this.ladder[0].heldout === null ? "" : " on runs held out"}.`,
    };
  }

  /** Is what is set now no step of the search? */
  apart() {
    const { now, forces } = this.app;
    return now && !forces && !this.ladder.some((s) => Math.abs(s.fit - now.fit) < 0.006 && Math.abs((s.heldout ?? 0) - (now.heldout || 0)) < 0.006);
  }

  sizes() {
    const { diagnosis, effects } = this.campaign, records = new Map(effects.map((e) => [e.id, e]));
    const rows = [proposed(this.campaign), ...diagnosis.ranking].filter((r) => r && records.has(r.effect)).flatMap((r) => records.get(r.effect).parameters.map((p) => {
      const own = r.parameters[p.name.split(".").at(-1)], several = records.get(r.effect).parameters.length > 1;
      if (!own || !p.delta) return null;
      const [low, high] = endsOf(own), { unit, factor } = display(p);
      return { name: capital(titleOf(this.campaign, r.effect)) + (several ? `: ${shortOf(p.name)}` : ""), value: own.estimate / p.delta, low: low / p.delta, high: high / p.delta,
        note: uncertain(own, p), unit_shown: unit, from: low * factor, to: high * factor, plainly: !own.interval, strong: r.verdict === "proposed" || diagnosis.effects.includes(r.effect), parameter: p.name, estimate: own.estimate * factor, se: own.se === null ? null : own.se * factor, delta: p.delta * factor };
    })).filter(Boolean);
    const strong = rows.filter((r) => r.strong);
    return {
      draw: (width, look, room) => forest(width, look, rows.slice(0, Math.max(room ? fitting(room) : FIRST, strong.length)), "size, as a multiple of the smallest that would matter", "shaded: too small to matter"),
      columns: () => tabled(rows, { name: "effect", estimate: "estimate", se: "standard error", from: "95 % from", to: "95 % to", delta: "matters from", unit_shown: "unit", value: "in sizes that matter", low: "95 % from, in sizes that matter", high: "95 % to, in sizes that matter", parameter: "name in files" }),
      caption: () => `Each effect's size as a multiple of the smallest that would matter, fitted or, of the less likely, estimated without fitting. ${strong.map((r) => `${r.name}: ${r.note}${r.note === UNSEEN || Math.abs(r.value) < 0.005 ? "" : `, ${significant(Math.abs(r.value), 2)} times that size`}`).join(". ")}${strong.length ? "." : `None of them ${diagnosis.verdict === "outside" ? "suffices" : "is needed"}.`}${rows.length > FIRST ? ` The likeliest of ${rows.length} sizes are drawn.` : ""}${plainly(rows)}`,
    };
  }

  calibrated() {
    const { calibration, final } = this.campaign.diagnosis, intervals = new Map((final?.parameters ?? []).map((p) => [p.name, p.interval])), records = new Map([...this.campaign.calibrated, ...this.campaign.constants].map((p) => [p.name, p]));
    const rows = Object.entries(calibration).filter(([, v]) => v.prior_sd).map(([name, v]) => {
      const at = (b, without) => (Number.isFinite(b) ? (b - v.prior) / v.prior_sd : without); // a bound, as far from what was given
      const off = (v.value - v.prior) / v.prior_sd, record = records.get(name) ?? { unit: "1" }, own = { estimate: v.value, se: v.se, interval: intervals.get(name) }, ends = endsOf(own);
      const [below, above] = ends.map((end) => (end - v.prior) / v.prior_sd);
      const bounds = v.at_bound ? [at(v.lower), at(v.upper)].filter(Number.isFinite) : [];
      const words = record.meaning ?? name, [low, high] = [Math.max(below, at(v.lower, -Infinity)), Math.min(above, at(v.upper, Infinity))];
      return { name: capital(words), words: words.replace(/ \p{L}_[\p{L}\d]+/u, ""), value: off, low, high, note: uncertain(own, record), under: `given ${withError(v.prior, v.prior_sd, record)}`, bounds, strong: Math.abs(off) > 2 || v.at_bound,
        parameter: name, unit: record.unit, given: v.prior, sd: v.prior_sd, fitted: v.value, se: v.se, low_end: Math.max(ends[0], v.lower ?? -Infinity), high_end: Math.min(ends[1], v.upper ?? Infinity), lower: v.lower, upper: v.upper, plainly: !own.interval, bound: v.at_bound ? "at its bound" : "" };
    });
    return {
      draw: (width, look) => forest(width, look, rows, "distance from what was given: 1 is how well that was known", "shaded: 95 % of what was given", 1.96),
      columns: () => tabled(rows, { name: "value", unit: "unit", given: "given", sd: "given to within (standard deviation)", fitted: "fitted", se: "standard error", low_end: "95 % from", high_end: "95 % to", lower: "lower bound", upper: "upper bound", bound: "bound", parameter: "name in files" }),
      caption: () => `What calibration made of the values that the campaign gives; zero is the value given, the band its 95 % interval as it was given, and each bar the 95 % interval now.${rows.some((r) => r.bound) ? ` Upright bars are bounds, shown where a value stands on one: ${listed(rows.filter((r) => r.bound).map((r) => r.words))}.` : " None stands on a bound."}${plainly(rows)}`,
    };
  }

  /** How the likelihood falls off about the estimates, of each size and of two rivals together. */
  landscape() {
    const { landscape: told } = this.campaign, curves = (told?.profiles ?? []).filter((c) => bowl(c.heights, c.level)), joint = told?.pair && bowl(told.pair.heights.flat(), told.pair.level) ? told.pair : null;
    byId("profiles").hidden = !curves.length;
    byId("joint").hidden = !joint;
    const tied = joint && this.campaign.diagnosis.ties.some((t) => joint.effects.every((e) => t.includes(e)));
    if (tied) byId("ties").append(byId("joint")); // before the other is drawn, which has its place then
    if (curves.length) this.add("profiles", "How sure each size is", this.profiled(curves));
    if (joint) this.add("joint", tied ? "Why these cannot be told apart" : "Two rivals together", this.joined(joint));
  }

  sizeOf(name) {
    const effect = this.campaign.effects.find((e) => e.parameters.some((p) => p.name === name)), record = effect.parameters.find((p) => p.name === name);
    return { record, name: capital(titleOf(this.campaign, effect.id)) + (effect.parameters.length > 1 ? ` (${shortOf(name)})` : "") };
  }

  profiled(curves) {
    const all = curves.map((c) => { const { record, name } = this.sizeOf(c.parameter), { factor, unit } = display(record); return { label: `${name} [${unitText(unit) || "1"}]`, xs: c.values.map((v) => v * factor), ys: c.heights, estimate: c.estimate * factor }; });
    return {
      draw: (width, look) => profiles(width, look, all, curves[0].level),
      columns: () => ({ size: all.flatMap((p) => p.xs.map(() => p.label)), value: all.flatMap((p) => p.xs), "how much worse it fits": all.flatMap((p) => p.ys) }),
      caption: () => `How much worse the model fits where a size is held at a value and all others are fitted again; below the dashed line lies 95 % by the noise of these runs alone. What is told allows besides for runs that differ by more, and for what else may be missing. ${curves.map((c) => this.sure(c)).join(" ")}`,
    };
  }

  /** A profile in words: its lowest place, and its 95 % interval as far as it was followed. */
  sure(curve) {
    const { record, name } = this.sizeOf(curve.parameter), ends = rankedOf(this.campaign, curve.parameter)?.interval ?? crossings(curve.values, curve.heights, curve.level);
    if (!ends.every(Number.isFinite)) return `${name}: ${inUnit(curve.estimate, record, 4)}.`;
    const low = ends.map((end, k) => stays(curve, end, k)), open = low.every(Boolean) ? "either way" : low[0] ? "below" : low[1] ? "above" : null;
    return `${name}: ${withInterval(curve.estimate, ends, record)}.${open ? ` ${capital(open)} that, its curve stays under the line as far as it is drawn: there the model runs another way, and the size may be farther off than is told.` : ""}`;
  }

  joined(joint) {
    const sizes = joint.parameters.map((n) => this.sizeOf(n)), alone = joint.parameters.map((n) => rankedOf(this.campaign, n)?.estimate ?? NaN);
    const [odds] = this.campaign.diagnosis.odds ?? [], far = joint.parameters.map((n) => n.split(".")[1]).find((e, k) => joint.alone_heights?.[k] > joint.level && odds?.[e]);
    const unlikely = far ? ` “${capital(titleOf(this.campaign, far))}” alone lies outside of it, so that these runs speak against it, but by ${chance(1 - odds[far])} to ${chance(odds[far])} only: other runs of the kind might not.` : "";
    const drawn = { ...joint, alone, names: sizes.map((s) => s.name), deltas: sizes.map((s) => s.record.delta),
      bounds: sizes.map(({ record: { lower, upper, delta } }) => [(lower ?? -Infinity) / delta, (upper ?? Infinity) / delta]) };
    const cells = joint.about.flatMap((v, j) => joint.about.map((u, i) => [...[0, 1].map((k) => joint.best[k] + joint.axes[k][0] * u + joint.axes[k][1] * v), joint.heights[j][i]]));
    return {
      draw: (width, look) => together(width, look, drawn),
      columns: () => ({ ...Object.fromEntries(sizes.flatMap(({ record, name }, k) => { const { unit, factor } = display(record); return [[`${name} [${unitText(unit) || "1"}]`, cells.map((c) => c[k] * factor)], [`${name}, in sizes that matter`, cells.map((c) => c[k] / record.delta)]]; })), "how much worse it fits": cells.map((c) => c[2]) }),
      caption: () => `Both sizes as multiples of the smallest that would matter: with a chance of ${Math.round(100 * (joint.share ?? 0.95))} % within the solid line, of 50 % within the dashed one, by the noise of these runs alone; within the shading neither would matter.${alone.every(Number.isFinite) ? ` The rings are either alone: ${sizes.map((s, k) => `“${s.name}” ${inUnit(alone[k], s.record)}`).join(", ")}.` : ""} Where the solid line meets a zero line, one effect would do without the other.${unlikely} The dot is what fits best with both in, ${listed(sizes.map((s, k) => inUnit(joint.best[k], s.record)))}.`,
    };
  }

  lacking(missing) {
    const all = missing.panels.map((p) => { const { factor, unit } = degrees(p.unit); return { variable: p.variable, unit: unitText(unit), label: `${capital(p.variable)} [${unitText(unit) || "1"}]`, xs: p.knots.map((v) => v * factor), ys: p.estimate, ses: p.se }; });
    const surely = all.flatMap((p) => p.xs.map((x, i) => ({ p, x, y: p.ys[i], se: p.ses[i] }))).filter((a) => Math.abs(a.y) > 1.96 * a.se);
    const most = surely.length ? surely.reduce((a, b) => (Math.abs(b.y) > Math.abs(a.y) ? b : a)) : null, record = { unit: missing.unit };
    const farthest = most ? ` Farthest from zero, of what is sure, it is ${withError(most.y, most.se, record)} at a ${most.p.variable} of ${beside(significant(most.x, 2), most.p.unit)}.` : "";
    return {
      draw: (width, look) => panels(width, look, all, unitText(missing.unit)),
      columns: () => ({ variable: all.flatMap((p) => p.xs.map(() => p.label)), at: all.flatMap((p) => p.xs), [`missing [${missing.unit}]`]: all.flatMap((p) => p.ys), se: all.flatMap((p) => p.ses) }),
      caption: () => `${capital(missing.words)} ${missing.ordered ? "that nobody recorded, as all readings of the fitted runs have it, beside what it goes with, with its 95 % band." : "as the runs would have it at the motion they had, a free function of one variable after another, with its 95 % band, as far as the runs tell it. A line that leaves zero shows what it goes with."}${farthest}`,
    };
  }

  above() {
    const { app } = this;
    return {
      draw: (width, look) => {
        const above = path(width, look, app.motion), top = Number(above.getAttribute("height")), [near, high] = app.scene.sketched(app.timeline.sample, width, look);
        return canvas(width, top + high, [...above.childNodes, svg("g", { transform: `translate(0 ${top})` }, near)]);
      },
      columns: () => ({ "time [s]": app.motion.time, "x [m]": app.motion.model.x, "y [m]": app.motion.model.y, "psi [rad]": app.motion.model.psi,
        ...(app.motion.measured ? { "x measured [m]": app.motion.measured.x, "y measured [m]": app.motion.measured.y } : {}),
        ...(app.motion.before ? { "x before [m]": app.motion.before.x, "y before [m]": app.motion.before.y } : {}),
        ...Object.fromEntries(Object.entries(WHEELS).map(([wheel, words]) => [`load of the ${words} [N]`, app.motion.results[`load.${wheel}`]])),
        ...Object.fromEntries(Object.entries(OF_THE_BODY).filter(([name]) => name in app.motion.inputs).map(([name, words]) => [words, app.motion.inputs[name]])) }),
      caption: () => {
        const { measured, model } = app.motion ?? {};
        if (!model) return "";
        const last = measured ? measured.x.findLastIndex((v, i) => Number.isFinite(v + measured.y[i])) : -1;
        return `Solid: where the sensors say the chair went; dashed: the model. Below, the chair ${app.timeline.at.toFixed(2)} s into the run.${last < 0 ? "" : ` ${last > model.x.length - LATE ? "At the end" : "Where that is last known"} they are ${significant(Math.hypot(model.x[last] - measured.x[last], model.y[last] - measured.y[last]), 2)} m apart.`}`;
      },
    };
  }

  curves() {
    const { app, campaign } = this, record = () => campaign.channels.find((c) => c.name === app.shown.channel);
    return {
      draw: (width, look, room = 0.54 * width + AXES) => {
        const high = Math.min(room - AXES, 0.54 * width), { timeline } = app, shown = timeline.lines.map(([name, values, colour, thick, dash]) => [name, values, colour, thick, dash]);
        const most = Math.max(4, ...Array.from(timeline.errors).filter(Number.isFinite).map(Math.abs));
        return lines(width, look, timeline.time, [timeline.from, timeline.to], [{ label: labelled(record()), lines: shown, edges: timeline.edges, height: high > LOW ? (2 / 3) * high : high }, ...(high > LOW ? [{ label: "error ÷ noise", lines: [["error", timeline.errors, "error", 1]], band: 2, reach: [-most, most], height: high / 3 }] : [])]);
      },
      columns: () => {
        const { factor, unit } = display(record()), run = campaign.runs[app.shown.run], result = app.results[app.shown.run], c = app.shown.channel, scaled = (v) => Array.from(v, (x) => x * factor), [low, high] = app.band(result).map(scaled);
        return { "time [s]": run.time, [`measured [${unit}]`]: scaled(run.channels[c]), [`model [${unit}]`]: scaled(result.predicted[c]), [`band from [${unit}]`]: low, [`band to [${unit}]`]: high,
          ...Object.fromEntries(app.timeline.lines.filter(([name]) => !["measured", "model"].includes(name)).map(([name, values]) => [`${name} [${unit}]`, Array.from(values)])), "error, noise = 1": result.errors[c] };
      },
      caption: () => {
        const result = app.printed ?? app.results[app.shown.run], was = app.printed ? `, ${rms(byChannel(app.before())[app.shown.channel])} before (dashed)` : "";
        return result ? `${capital(channelOf(app.shown.channel))} of ${runOf(campaign.runs[app.shown.run])}. Its error is ${rms(byChannel(result)[app.shown.channel])} times the noise${was}; 95 of 100 errors of a perfect model lie within twice the noise. The band about the model holds 95 of 100 readings if it is right, by the noise of sensor and pushes${app.forces ? ", by forces that nobody recorded" : ""}${!app.printed && app.doubt() ? " and by how uncertain its fitted values are" : app.printed ? ", with the values that the search found" : ", with its values as they are set"}.` : "";
      },
    };
  }

  places() {
    return {
      draw: (width, look) => heat(width, look, this.campaign.channels.map((c) => channelOf(c.name)), this.placed()),
      columns: () => { const cells = this.placed().flatMap((r) => r.cells.map((c) => [r.name, ...c.at.slice(1), c.value])); return { run: cells.map((c) => c[0]), channel: cells.map((c) => c[1]), "error, noise = 1": cells.map((c) => c[2]) }; },
      caption: () => `Error of each run and channel, ${this.app.printed ? "before what was found was put in" : this.app.called()}, in units of the noise; colour begins at ${QUIET}.${this.greatest()}`,
    };
  }

  /** The greatest error of a run's channel. */
  greatest() {
    const cells = this.placed().flatMap((r) => r.cells).filter((c) => Number.isFinite(c.value)), most = cells.reduce((a, b) => (a && a.value >= b.value ? a : b), null);
    return most ? ` The greatest is ${rms(most.value)}, of the ${channelOf(most.at[1])} of ${runOf(this.campaign.runs[most.at[0]])}.` : "";
  }

  placed() {
    const { runs, channels } = this.campaign;
    return runs.map((run, i) => {
      const own = this.app.results[i] ? byChannel(this.app.results[i]) : {};
      return { name: run.name, note: run.role === "holdout" ? "held out" : "", cells: channels.map((c) => ({ value: own[c.name], at: [i, c.name], label: `${run.name}, ${channelOf(c.name)}: show it` })) };
    });
  }

  moments() {
    const { app, campaign } = this, panels = () => this.against ?? [];
    return {
      file: () => `${campaign.name}-regimes-${app.shown.channel}`,
      draw: (width, look) => drawnAgainst(width, look, panels()),
      columns: () => ({ regime: panels().flatMap((p) => p.xs.map(() => p.label)), at: panels().flatMap((p) => p.xs), "mean error, noise = 1": panels().flatMap((p) => p.means), "2.5 % lie below": panels().flatMap((p) => p.lows), "2.5 % lie above": panels().flatMap((p) => p.highs) }),
      caption: () => `Error of the ${channelOf(app.shown.channel)} in all runs, measured less model, in units of the noise: its mean, and about it where 95 of 100 readings lie; of a perfect model 95 of 100 lie between the dashed lines. A line that leaves zero shows when the model fails.${this.worst()}`,
    };
  }

  /** When the error over all channels is greatest. */
  worst() {
    const most = (this.rows ?? []).reduce((a, b) => (a && a.rms >= b.rms ? a : b), null);
    return most?.rms > QUIET ? ` Over all channels the error is greatest, ${rms(most.rms)} times the noise, where the ${most.name} is ${between(most.from, most.to, this.campaign.regimes.find((r) => r.name === most.name))}.` : "";
  }

  units() {
    const all = this.app.physical(), { campaign } = this;
    return {
      draw: (width, look) => {
        const shown = all.map((r) => ({ name: `${capital(r.channel)} [${r.unit || "1"}]`, cells: r.values.map((v) => ({ value: v.times, ...(v.value === undefined ? {} : { shown: significant(v.value, 2), note: `${rms(v.times)} ×` }) })) }));
        return heat(width, look, all[0]?.values.map((v) => v.step) ?? [], shown);
      },
      columns: () => { const cells = all.flatMap((r) => r.values.map((v) => [r.channel, v.step, v.value, r.unit, v.times])); return { channel: cells.map((c) => c[0]), step: cells.map((c) => c[1]), error: cells.map((c) => c[2]), unit: cells.map((c) => c[3]), "noise = 1": cells.map((c) => c[4]) }; },
      caption: () => `Error of each channel on ${this.app.judged()}, at each step: large, by how much the readings are missed, and small, how many times what the noise of sensors and pushes gives.${campaign.channels.some((c) => ADDS_UP.includes(c.name)) ? " In a place or a heading that noise adds up along a run, so that the two need not fall alike." : ""}${this.missed(all)}`,
    };
  }

  /** What the search changed most, in the unit of a sensor. */
  missed(rows) {
    const known = rows.filter((r) => r.values.length > 1 && r.values.every((v) => v.value !== undefined)), begun = this.ladder.findIndex((s) => s.step === this.campaign.diagnosis.begins), fall = (r) => r.values[begun].times - r.values.at(-1).times, most = known.reduce((a, b) => (a && fall(a) >= fall(b) ? a : b), null);
    return most ? ` The ${most.channel} is missed by ${listed(most.values.map((v) => `${beside(significant(v.value, 2), most.unit)} ${stillOf(v.step)}`))}.` : "";
  }

  /** What follows a change at once, where it is in sight. */
  follow() {
    if (this.heatWhere.seen) this.heats();
  }

  heats() {
    this.heatWhere.show(this.placed(), ([run, channel]) => run === this.app.shown.run && channel === this.app.shown.channel);
  }

  /** The rest, once values rest. */
  rested() {
    const { campaign, app } = this;
    this.rows = excessBy(campaign.regimes, campaign.runs, app.results);
    this.against = against(campaign.regimes, campaign.runs, app.results, app.shown.channel);
    this.heats();
    for (const id of ["path", "overlay", "where"]) this.all[id].said();
    for (const id of ["staircase", "regimes"]) this.all[id].redraw();
  }

  redraw() {
    for (const f of Object.values(this.all)) if (!f.own) f.redraw();
  }
}

