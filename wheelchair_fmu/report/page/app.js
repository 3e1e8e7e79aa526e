// The page: what the reader sets, the workers' answers, and everything that follows.

import * as address from "page/address";
import { Controls, same } from "page/controls";
import { byId, h, sized, unpacked, write } from "page/dom";
import { look } from "page/draw";
import { together } from "page/errors";
import { evidence } from "page/evidence";
import { Figures } from "page/figures";
import { lacking, reckoned, rolled } from "page/motion";
import { mini } from "page/mini";
import { beside, rms, significant, unitText } from "page/numbers";
import { papers } from "page/paper";
import { Pins } from "page/pins";
import { Pool } from "page/pool";
import { kept, refit, starts } from "page/refit";
import { Scene } from "page/scene";
import { Story } from "page/story";
import { Timeline } from "page/timeline";
import { channelOf, lawsOf, runOf, stepOf } from "page/words";

const REST = 180; // ms without a change after which the numbers are made exact
const WRITTEN = 250; // ms after which the address follows
const AT_ONCE = 100; // ms within which what follows a movement is seen as part of it
const SEEN = 0.2; // fall of a channel's mean square error, noise = 1, that one sees in its curve
const FORCES = "unrecorded forces"; // the step of the search from which on they are among the noise
const DEEP = 60; // changes that can be undone
const NORMAL = 1.96; // standard deviations either side that hold 95 %

class App {
  constructor(campaign) {
    this.campaign = campaign;
    this.results = [];
    this.timings = [];
    this.costs = [];
    this.doubts = new Map(); // by run: variances of readings by the uncertainty of the last model's values; null while they are made
    this.known = new Set(["calibrated", "effects"].flatMap((k) => campaign[k]).flatMap((p) => (p.parameters ?? [p]).map((q) => q.name)).concat(campaign.diagnosis.models.flatMap((m) => Object.keys(m.values))));
    this.state = address.read(location.hash, campaign, this.known);
    if (this.state.theme) document.documentElement.dataset.theme = this.state.theme;
    this.forces = campaign.diagnosis.ladder.some((s) => s.step === FORCES);
    byId("forces").hidden = !this.forces;
    this.figures = new Figures(campaign, this);
    this.fallen();
    evidence(campaign);
  }

  /** All that needs the model; throws where the browser has no workers or no WebAssembly. */
  begin() {
    const { campaign, state } = this;
    if (typeof WebAssembly !== "object" || typeof Worker !== "function") throw new Error("it has no WebAssembly or no workers");
    this.pool = new Pool(byId("worker").textContent, campaign, (run, result) => this.heard(run, result), (words) => this.give(words));
    this.shown = this.firstShown();
    this.mini = document.querySelector(".mini");
    this.room = sized(this.mini);
    this.figures.alive();
    this.scene = new Scene(this.figures.all.path.drawing, campaign);
    this.timeline = new Timeline(this.figures.all.overlay.drawing, this.figures.all.path.drawing, campaign, this.scene, (channel) => this.show(this.shown.run, channel), () => this.write());
    this.timeline.begin(campaign.runs[this.shown.run], state);
    this.controls = new Controls(byId("controls"), campaign, state.values, (values) => this.set(values), (values, effects) => this.fitTogether(values, effects));
    this.start = this.controls.start();
    this.opensAtStart = same(this.controls.values, this.start.values);
    this.history = { at: -1, all: [] };
    this.pick = this.picker();
    this.pins = new Pins(campaign, state.pins ?? [], () => this.pinned(), (values) => this.put(values));
    this.story = new Story(campaign, this, state, () => this.write());
    this.buttons();
    this.foretell();
    this.set(this.controls.values);
    document.documentElement.classList.remove("lifeless");
  }

  /** The model cannot run here: what is stored stands, and one sentence says so. */
  give(why) {
    document.documentElement.classList.add("lifeless");
    byId("plea").hidden = false;
    byId("plea").textContent = `This browser cannot run the model (${why}); everything that the diagnosis stored stands below.`;
    byId("try").hidden = true;
    for (const stage of document.querySelectorAll(".stage")) stage.replaceChildren(...stage.querySelectorAll(".guesses, .choices-list, .answer"));
    this.figures.redraw();
  }

  /** Where the page opens at a step of the search, its errors are in the diagnosis: they stand at once. */
  foretell() {
    const step = this.opensAtStart && !this.forces && this.campaign.diagnosis.ladder.find((s) => s.step === this.start.step);
    if (!step) return;
    byId("now-fit").textContent = rms(step.fit);
    byId("now-heldout").textContent = rms(step.heldout);
  }

  /** The run that opens: what the address says, held out, or the first; the channel is decided by the first exact errors. */
  firstShown() {
    const { runs } = this.campaign, said = runs.findIndex((r) => r.name === this.state.run);
    const at = said >= 0 ? said : Math.max(runs.findIndex((r) => r.role === "holdout"), 0);
    return { run: at, channel: this.state.channel ?? Object.keys(runs[at].channels)[0], chosen: said >= 0 };
  }

  get values() {
    return this.controls.values;
  }

  put(values) {
    this.controls.put(values);
  }

  /** Simulate everything with these values: quickly now, exactly once they rest. */
  set() {
    this.settled = false;
    clearTimeout(this.resting);
    if (this.running && !this.running.exact) this.pending = true;
    else this.ask(this.results.filter(Boolean).length < this.campaign.runs.length);
  }

  ask(exact) {
    const rest = this.campaign.runs.map((_, i) => i).filter((i) => i !== this.shown.run);
    this.pending = false;
    const held = !exact && this.took < AT_ONCE; // then the curve waits for the numbers, and both are of the same values
    this.running = { exact, held, left: new Set([this.shown.run, ...rest]), began: performance.now(), one: null };
    this.say(...(exact ? ["making the numbers exact …", "busy"] : ["about, while it moves", "quick"])); // the same all along: nothing flickers
    this.pool.ask([...this.running.left], this.values, exact, (run) => exact || run === this.shown.run);
  }

  heard(run, result) {
    const { running } = this;
    running.left.delete(run);
    if (result.error) this.failed = `${this.campaign.runs[run].name}: ${result.error}`;
    else this.results[run] = result.brief ? { ...this.results[run], ...result } : result;
    if (run === this.shown.run && !result.error) {
      running.one = performance.now() - running.began;
      if (!running.held) this.want("run");
    }
    if (!running.left.size) this.complete();
  }

  complete() {
    const { exact, began, one, held } = this.running;
    this.running = null;
    if (held) this.want("run");
    if (!exact) this.took = performance.now() - began;
    if (this.failed) {
      this.say(this.failed, "failed");
      this.failed = null;
    } else {
      this.now = this.error();
      if (exact && !this.opened) this.firstTime();
      if (exact && this.parting) this.parted();
      this.want(exact ? "rested" : "all");
      if (exact && !this.pending) this.record();
      this.say(this.fitting ? "fitting the sizes together …" : exact ? "exact" : "about, while it moves", this.fitting ? "busy" : exact ? "exact" : "quick");
      requestAnimationFrame(() => setTimeout(() => { this.timings.push({ exact, one, all: performance.now() - began }); this.settled = exact && !this.fitting && !this.running; }));
    }
    if (this.pending) this.ask(false);
    else if (!exact && !this.fitting) this.resting = setTimeout(() => this.ask(true), REST); // a fit ends with values of its own
  }

  error() {
    const { runs } = this.campaign;
    return { fit: together(runs, this.results, "fit"), heldout: together(runs, this.results, "holdout") };
  }

  /** After the first exact numbers: the largest error is what the reader sees, until it is known what the search gained. */
  firstTime() {
    this.exactAt = performance.now();
    this.opened = this.opensAtStart ? [...this.results] : [];
    if (!this.shown.chosen) this.turnTo((i, c) => this.results[i].squares[c] / this.results[i].counts[c]);
    this.later();
    this.pinned();
  }

  /** The run and channel of which something is greatest, in runs held out, or in any where it is not `enough` there. */
  turnTo(measure, enough = -Infinity) {
    let most = -Infinity, best = this.shown;
    for (const wanted of [this.judgedRuns(), this.campaign.runs.map((_, i) => i)]) {
      if (most > enough) break;
      for (const i of wanted)
        for (const channel of Object.keys(this.campaign.runs[i].channels)) {
          const size = measure(i, channel);
          if (size > most) [most, best] = [size, { run: i, channel, chosen: false }];
        }
    }
    if (best.run !== this.shown.run || best.channel !== this.shown.channel) this.turn(best);
  }

  /** The last step of the search, simulated beside, for where it gained; where nothing was put in, the largest error stays in sight. */
  async later() {
    const { values } = this.campaign.diagnosis.models.at(-1);
    if (this.shown.chosen || !this.opensAtStart || same(values, this.start.values)) return;
    this.gained(await Promise.all(this.campaign.runs.map((_, run) => this.pool.later({ run, values, aside: true, brief: true }).catch(() => null))));
  }

  /** The shown run by the last step of the search, whole: on paper what was found is seen beside what was before. */
  async foundThere() {
    const { run } = this.shown, { values } = this.campaign.diagnosis.models.at(-1);
    if (this.found?.run === run || !this.opensAtStart || same(values, this.start.values)) return;
    const result = await this.pool.later({ run, values, aside: true }).catch(() => null);
    if (result && this.shown.run === run) this.found = { run, result };
  }

  /** On paper, where nothing was set by hand, the curve of what was found beside that of before. */
  onPaper() {
    const { found, shown } = this, before = this.before();
    if (found?.run !== shown.run || !before || !same(this.values, this.start.values) || !found.result.predicted?.[shown.channel]) return;
    this.printed = found.result;
    this.timeline.show(shown.channel, found.result, before, [], this.band(found.result, null));
    this.explained();
  }

  offPaper() {
    if (!this.printed) return;
    this.printed = null;
    this.explained();
  }

  explained() {
    for (const id of ["overlay", "where"]) this.figures.all[id].said();
  }

  /** The fall of the error in a sensor's own unit, on the card that says how sure it is. */
  fallen() {
    const { begins: from, models } = this.campaign.diagnosis, to = models.at(-1).step;
    if (from === to) return;
    const names = [from, to].map((s) => stepOf(this.campaign, s)), rows = this.physical().map((r) => ({ ...r, ends: names.map((n) => r.values.find((v) => v.step === n)) }));
    const most = rows.filter((r) => r.ends.every((v) => v?.value)).sort((a, b) => b.ends[0].times - b.ends[1].times - (a.ends[0].times - a.ends[1].times))[0];
    if (!most || most.ends[0].times <= most.ends[1].times) return;
    const [was, now] = most.ends.map((v) => beside(significant(v.value, 2), most.unit));
    if (was === now) return;
    const words = `There the ${most.channel} is missed by ${was} before and ${now} after.`;
    const card = document.querySelectorAll(".card")[1];
    if (!card) return; // a page may tell of a campaign alone
    [...card.querySelectorAll("p:not(.lead)")].find((p) => /\berror\b/.test(p.textContent) && /kept back|fitted to/.test(p.textContent))?.after(h("p", { class: "physical" }, words));
  }

  /** Where the search gained most is what the reader sees, unless he has chosen. */
  gained(last) {
    if (this.shown.chosen || last.includes(null)) return this.foundThere();
    const mean = (r, c) => r.squares[c] / r.counts[c], fall = (i, c) => (mean(this.opened[i], c) - mean(last[i], c)) * (c in last[i].squares ? 1 : 0);
    this.turnTo(fall, SEEN);
    this.foundThere();
  }

  /** Turns to where the model parts most from the one that the search began with, unless the reader has chosen. */
  parted() {
    this.parting = false;
    if (this.shown.chosen || !this.opened?.length) return;
    this.left ??= this.shown;
    const mean = (r, c) => r.squares[c] / r.counts[c];
    this.turnTo((i, c) => mean(this.results[i], c) - mean(this.opened[i], c));
  }

  /** Turns back to where it was before. */
  returned() {
    if (this.left && !this.shown.chosen) this.turn(this.left);
    this.left = null;
  }

  /** The shown run as it was where the search began. */
  before() {
    const { run } = this.shown, there = this.opened?.[run] ?? this.beforehand?.[run];
    if (there || !this.opened || this.opensAtStart) return there ?? null;
    this.beforehand ??= [];
    if (this.asking !== run) {
      this.asking = run;
      this.pool.later({ run, values: this.start.values, aside: true }).then((result) => { this.beforehand[run] = result; this.want("run"); }).catch(() => {});
    }
    return null;
  }

  /** What the uncertainty of fitted values adds to the shown run's readings: variances by channel, null where values were set by
   *  hand, or not yet known. */
  doubt() {
    const { diagnosis } = this.campaign, { run } = this.shown, { values } = diagnosis.models.at(-1);
    if (!diagnosis.final || !same(this.values, values)) return null;
    if (!this.doubts.has(run)) {
      const { parameters, covariance } = diagnosis.final;
      this.doubts.set(run, null);
      this.pool.later({ run, values, doubt: { names: parameters.map((p) => p.name), covariance } }).then(({ variance }) => { this.doubts.set(run, variance); this.want("run"); if (this.settled) this.want("rested"); }).catch(() => {});
    }
    return this.doubts.get(run);
  }

  /** [low, high] about the shown channel of a result of the shown run: 95 % of readings lie between them where the model is right;
   *  `variance` is what the uncertainty of its values adds. */
  band(result, variance = this.doubt()?.[this.shown.channel]) {
    const { channel } = this.shown, mean = result.predicted[channel], sd = result.sd[channel], low = mean.slice(), high = mean.slice();
    for (let i = 0; i < mean.length; i++) {
      const half = NORMAL * (variance ? Math.sqrt(sd[i] * sd[i] + variance[i]) : sd[i]);
      low[i] -= half;
      high[i] += half;
    }
    return [low, high];
  }

  /** [{channel, unit, values: [{step, value, times}]}] of runs held out, where there are any, as the search had them. */
  physical() {
    const { campaign } = this, { ladder } = campaign.diagnosis;
    return campaign.channels.map(({ name }) => {
      const told = ladder.filter((s) => s.channels?.[name]).map((s) => ({ step: stepOf(campaign, s.step), ...s.channels[name] }));
      return { channel: channelOf(name), unit: unitText(told[0]?.unit ?? ""), values: told.map((e) => ({ step: e.step, value: e.heldout_rms ?? e.fit_rms, times: e.heldout ?? e.fit })) };
    }).filter((r) => r.values.length);
  }

  judgedRuns() {
    const held = this.campaign.runs.map((_, i) => i).filter((i) => this.campaign.runs[i].role === "holdout");
    return held.length ? held : this.campaign.runs.map((_, i) => i);
  }

  /** The model as it is shown: a step of the search, or values that the reader has set. */
  called() {
    const { diagnosis } = this.campaign, there = this.printed ? diagnosis.models.at(-1) : diagnosis.models.find((m) => same(m.values, this.values));
    if (!there) return "with values set by hand";
    return there === diagnosis.models.at(-1) && there.step.startsWith("+") ? "with what the search found" : `model ${stepOf(this.campaign, there.step)}`;
  }

  judged() {
    return this.campaign.runs.some((r) => r.role === "holdout") ? "runs held out" : "the fitted runs";
  }

  show(run, channel) {
    const there = this.campaign.runs[run].channels, wanted = channel ?? this.shown.channel;
    this.turn({ run, channel: wanted in there ? wanted : Object.keys(there)[0], chosen: true });
    this.write();
  }

  turn(shown) {
    const other = shown.run !== this.shown.run;
    this.shown = shown;
    this.pick.show(shown);
    if (other) this.timeline.begin(this.campaign.runs[shown.run]);
    if (other && this.opened) this.foundThere();
    if (other && !this.settled && this.results[shown.run]?.brief) this.set();
    if (other && this.pins.kept.length) this.pinned();
    this.want("run");
    if (this.settled) this.want("rested");
  }

  /** Draw with the next frame; of several wishes the greatest counts. */
  want(what) {
    this.wished ??= new Set();
    this.wished.add(what);
    this.frame ??= requestAnimationFrame(() => this.paint());
  }

  paint() {
    const began = performance.now(), wished = this.wished;
    this.frame = this.wished = null;
    if (!wished) return;
    if (wished.has("run")) this.drawRun();
    if (wished.has("all") || wished.has("rested")) this.drawAll(wished.has("rested"));
    this.costs.push({ ms: performance.now() - began, rested: wished.has("rested") });
  }

  drawRun() {
    const result = this.results[this.shown.run], before = this.before();
    if (!result?.predicted) return;
    const run = this.campaign.runs[this.shown.run], { geometry } = this.campaign, at = result.results;
    const moved = (r) => ({ x: r["chair.x"], y: r["chair.y"], psi: r["chair.psi"] });
    this.motion = { time: run.time, model: moved(at), measured: reckoned(run, at), before: before && before !== result ? moved(before.results) : null, results: at, inputs: run.inputs, friction: this.values["tyre.mu"] ?? run.set["tyre.mu"] ?? geometry.mu,
      rolled: rolled(run.time, at, geometry.t_r), lacking: lacking(run, result, { mass: this.values["chair.m"] ?? geometry.m, inertia: this.values["chair.I_z"] ?? geometry.I_z }) };
    this.scene.show(this.motion, this.look ??= look(), run.name);
    write(byId("laws"), `Laws of this model: ${lawsOf(this.campaign.models[result.model].laws)}.`);
    const pinned = this.pins.kept.map((k) => [k.label, k.results?.[this.shown.run]]).filter(([, r]) => r?.predicted);
    this.timeline.show(this.shown.channel, result, before, pinned, this.band(result));
    mini(this.mini, this.room(), this.look, run.channels[this.shown.channel], result.predicted[this.shown.channel]);
  }

  /** `rested`: also what takes long to sort. */
  drawAll(rested) {
    write(byId("now-fit"), rms(this.now.fit));
    write(byId("now-heldout"), rms(this.now.heldout));
    this.figures.follow();
    this.story.draw(rested);
    if (!rested) return;
    this.figures.rested();
    this.pins.show({ values: this.values, errors: this.now });
    const spoken = `Error on runs held out ${rms(this.now.heldout)}, on fitted runs ${rms(this.now.fit)}; 1.00 is noise alone.`;
    write(byId("said"), spoken);
  }

  /** Settings that are kept: what of them is not known is simulated beside. */
  pinned() {
    this.pins.show({ values: this.values, errors: this.now });
    this.write();
    return (this.pinning = (this.pinning ?? Promise.resolve()).then(() => this.simulatedPins())); // what one has asked for, the next has
  }

  async simulatedPins() {
    for (const one of this.pins.kept) {
      one.results ??= [];
      const { run } = this.shown;
      one.results[run] ??= await this.pool.later({ run, values: one.values, aside: true }).catch(() => null);
      if (!one.errors) {
        const all = await Promise.all(this.campaign.runs.map((_, i) => this.pool.later({ run: i, values: one.values, aside: true, brief: true }).catch(() => null)));
        one.errors = { fit: together(this.campaign.runs, all, "fit"), heldout: together(this.campaign.runs, all, "holdout") };
      }
    }
    this.pins.show({ values: this.values, errors: this.now });
    this.want("run");
  }

  /** The sizes of what is ticked, and the calibrated values, fitted together; `doubted` are effects that may be far from theirs. */
  async fitTogether(values, doubted = []) {
    const names = Object.keys(values).filter((n) => (n.startsWith("effect.") ? values[n] !== 0 : n.startsWith("offset."))).concat(this.campaign.calibrated.map((p) => p.name));
    const mine = (this.fitting = { values });
    this.say("fitting the sizes together …", "busy");
    const found = await refit(this.pool, this.campaign, starts(values, doubted), names, () => this.fitting === mine && this.values === values).catch((error) => { this.failed = error.message; return null; });
    if (this.fitting !== mine) return;
    this.fitting = null;
    if (found && this.values === values) this.put(kept(found, this.campaign.effects.filter((e) => e.parameters.some((p) => values[p.name]))));
    else this.set();
  }

  /** What can be undone: settings at rest. */
  record() {
    const { history } = this;
    if (this.fitting || (history.at >= 0 && same(history.all[history.at], this.values))) return this.enable();
    history.all = [...history.all.slice(0, history.at + 1), { ...this.values }].slice(-DEEP);
    history.at = history.all.length - 1;
    this.enable();
    this.write();
  }

  go(by) {
    const { history } = this, at = history.at + by;
    if (!history.all[at]) return;
    history.at = at;
    this.put({ ...history.all[at] });
  }

  enable() {
    byId("undo").disabled = this.history.at <= 0;
    byId("redo").disabled = this.history.at >= this.history.all.length - 1;
  }

  buttons() {
    byId("undo").addEventListener("click", () => this.go(-1));
    byId("redo").addEventListener("click", () => this.go(1));
    byId("reset").addEventListener("click", () => this.put({ ...this.start.values }));
    byId("link").addEventListener("click", () => this.copy());
  }

  /** The address follows, when things rest. */
  write() {
    clearTimeout(this.writing);
    this.writing = setTimeout(() => this.written(), WRITTEN);
  }

  written() {
    const { timeline, shown, campaign } = this, { time } = timeline, theme = document.documentElement.dataset.theme, round = (v) => Math.round(v * 1000) / 1000;
    const zoomed = timeline.from !== time[0] || timeline.to !== time.at(-1);
    this.hash = address.write({ ...(same(this.values, this.start.values) ? {} : { values: this.values }), run: campaign.runs[shown.run].name, channel: shown.channel, t: round(timeline.at),
      ...(zoomed ? { from: round(timeline.from), to: round(timeline.to) } : {}), screen: this.story.at, ...this.story.guess(), ...timeline.pace(), ...(this.pins.kept.length ? { pins: this.pins.kept.map((k) => k.values) } : {}), ...(theme ? { theme } : {}) });
    history.replaceState(null, "", this.hash);
  }

  async copy() {
    this.written();
    const button = byId("link"), words = button.textContent;
    button.textContent = await navigator.clipboard.writeText(location.href).then(() => "copied", () => "the address is the link");
    setTimeout(() => { button.textContent = words; }, 2000);
  }

  recolour() {
    this.look = look();
    this.timeline?.recolour();
    this.figures.redraw();
    if (this.pool) { this.want("run"); if (this.now) this.want("rested"); }
  }

  resize() {
    this.figures.redraw();
    this.timeline?.resize();
    this.want("run");
    if (this.now) this.want("rested");
  }

  say(words, state) {
    const status = byId("status");
    write(status, words);
    if (status.dataset.state !== state) status.dataset.state = state;
  }

  picker() {
    const run = h("select", { id: "run", onchange: () => this.show(Number(run.value), channel.value) });
    const channel = h("select", { id: "channel", onchange: () => this.show(Number(run.value), channel.value) });
    this.campaign.runs.forEach((r, i) => run.append(h("option", { value: i }, runOf(r))));
    byId("pick").append(h("label", {}, "Run ", run), h("label", {}, "Channel ", channel));
    const show = (shown) => {
      run.value = shown.run;
      channel.replaceChildren(...Object.keys(this.campaign.runs[shown.run].channels).map((c) => h("option", { value: c }, channelOf(c))));
      channel.value = shown.channel;
    };
    show(this.shown);
    return { show };
  }
}

function themed(redraw) {
  const root = document.documentElement, media = matchMedia("(prefers-color-scheme: dark)");
  const dark = () => (root.dataset.theme ? root.dataset.theme === "dark" : media.matches);
  byId("theme").addEventListener("click", () => {
    root.dataset.theme = dark() ? "light" : "dark";
    redraw();
    if (window.report.pool) window.report.write();
  });
  media.addEventListener("change", redraw);
}

/** One sentence where this browser cannot do what the page needs. */
function plead(why) {
  byId("plea").hidden = false;
  byId("plea").textContent = `This browser cannot run the model (${why}); what the diagnosis found stands in the text.`;
  for (const id of ["try", "evidence", "ties"]) byId(id).hidden = true;
}

async function opened() {
  if (typeof DecompressionStream !== "function") throw new Error("it cannot unpack the measurements");
  const app = new App(await unpacked(byId("content").textContent));
  window.report = app; // for whoever wants to script the page
  themed(() => app.recolour());
  try {
    app.begin();
  } catch (error) {
    app.pool = null;
    app.give(error.message);
  }
  return app;
}

const app = await opened().catch((error) => { plead(error.message); throw error; });
let width = innerWidth, settling;
addEventListener("resize", () => {
  clearTimeout(settling);
  if (innerWidth !== width) settling = setTimeout(() => app.resize((width = innerWidth)), REST);
});
addEventListener("hashchange", () => { if (address.isState(location.hash) && location.hash !== app.hash) location.reload(); });
let theme, printed = [];
addEventListener("beforeprint", () => {
  theme = document.documentElement.dataset.theme;
  document.documentElement.dataset.theme = "light"; // paper is white
  app.recolour();
  if (app.wished) app.paint();
  if (app.timeline?.result) app.onPaper();
  for (const p of printed) p.remove();
  const { overlay, ...others } = app.figures.all;
  printed = papers(app.timeline?.result ? { overlay, ...others } : others, app.campaign.runs.length);
});
addEventListener("afterprint", () => {
  app.offPaper();
  for (const p of printed.splice(0)) p.remove();
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  app.recolour();
});
