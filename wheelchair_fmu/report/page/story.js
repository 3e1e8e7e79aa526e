// The five screens, one at a time: each with something to see or to do.

import { byId, h } from "page/dom";
import { extent, look } from "page/draw";
import { same } from "page/controls";
import { byChannel } from "page/errors";
import { Figure } from "page/figure";
import { bars } from "page/forest";
import { labelled, lines } from "page/lines";
import { rms } from "page/numbers";
import { capital, channelOf, runOf, titleOf } from "page/words";

const SLIGHT = 1.5; // error of a channel, noise = 1: below that, its curves hardly part to the eye
const LEAST = 0.6; // of an axis of mean errors either side of zero, so that what is next to nothing looks it
const SEEN = 0.015; // fall of the error, noise = 1, that one would call a fall
const HALF = 0.25; // s either side of a mean

/** Means of a series over half a second. */
function smooth(time, values) {
  const sums = new Float64Array(values.length + 1), counts = new Float64Array(values.length + 1);
  values.forEach((v, i) => { const there = Number.isFinite(v); sums[i + 1] = sums[i] + (there ? v : 0); counts[i + 1] = counts[i] + there; });
  let low = 0, high = 0;
  return Float64Array.from(time, (t) => {
    while (time[low] < t - HALF) low++;
    while (high < time.length && time[high] <= t + HALF) high++;
    return (sums[high] - sums[low]) / (counts[high] - counts[low]);
  });
}

export class Story {
  /** `app` has values, results and put; `turned(screen)` hears which is open. */
  constructor(campaign, app, { screen, guess }, turned) {
    Object.assign(this, { campaign, app, turned });
    this.screens = [...document.querySelectorAll(".screen")];
    this.last = campaign.diagnosis.models.at(-1);
    this.tabs = this.screens.map((s, i) => h("button", { type: "button", class: "tab", onclick: () => this.go(i, true) }, h("b", {}, String(i + 1)), h("span", {}, s.querySelector("h3").lastChild.textContent.trim())));
    byId("steps").replaceChildren(...this.tabs);
    byId("steps").hidden = false;
    byId("screens").classList.add("one");
    this.screens.forEach((s, i) => s.append(h("p", { class: "turn" },
      i ? h("button", { type: "button", class: "quiet", onclick: () => this.go(i - 1, true) }, "← back") : null,
      i < this.screens.length - 1 ? h("button", { type: "button", class: "step", "aria-pressed": "true", onclick: () => this.go(i + 1, true) }, "next →") : null)));
    this.stages = Object.fromEntries(this.screens.map((s) => [s.dataset.kind, s.querySelector(".stage")]));
    this.guessing();
    this.putting();
    this.advising();
    new IntersectionObserver(([entry]) => { this.seen = entry.isIntersecting; }).observe(this.curve);
    this.go(Math.min(Math.max(Math.round(screen ?? 0), 0), this.screens.length - 1));
    this.guesses.get(guess)?.click();
  }

  /** What was guessed, for the address. */
  guess() {
    return this.choice ? { guess: this.choice.effect } : {};
  }

  told(kind) {
    return this.campaign.story.screens.find((s) => s.kind === kind);
  }

  go(at, byHand = false) {
    this.at = at;
    if (this.screens[at].dataset.kind !== "put") this.app.returned();
    else if (this.parts() && this.isIn()) this.app.parted();
    this.screens.forEach((s, i) => { s.hidden = i !== at; });
    this.tabs.forEach((t, i) => t.setAttribute("aria-current", i === at ? "step" : "false"));
    if (byHand) { this.screens[at].querySelector("h3").focus({ preventScroll: true }); this.turned(at); }
    this.draw();
  }

  /** A guess is answered in words and, where the search refitted it, by its curve. */
  guessing() {
    const answer = h("p", { class: "answer", role: "status" });
    this.guessed = h("div", { class: "curve" });
    const told = this.told("guess").choices, choices = told.map((c) => h("button", { type: "button", class: "choice", "aria-pressed": "false", onclick: ({ currentTarget }) => {
      for (const b of choices) b.setAttribute("aria-pressed", b === currentTarget);
      currentTarget.dataset.right = c.right;
      answer.textContent = c.answer;
      this.choice = c;
      this.reveal();
      this.turned();
    } }, capital(c.title)));
    this.guesses = new Map(told.map((c, i) => [c.effect, choices[i]]));
    this.stages.guess.replaceChildren(h("div", { class: "choices-list" }, choices), answer, this.guessed);
  }

  async reveal() {
    const { choice, app } = this, { run } = app.shown, values = this.campaign.diagnosis.ranking.find((r) => r.effect === choice?.effect)?.values;
    const after = values ? await app.pool.later({ run, values, aside: true }).catch(() => null) : null;
    if (choice !== this.choice || run !== app.shown.run) return;
    this.revealed = { choice, run, after };
    this.drawGuess();
  }

  /** The curve of a guess, again where the run, the width or the theme is another one. */
  drawGuess() {
    const { choice, app, revealed } = this;
    if (!choice) return;
    if (revealed?.choice !== choice || revealed.run !== app.shown.run) this.reveal();
    else this.guessed.replaceChildren(...(revealed.after ? this.curves(app.before(), revealed.after, choice.beside ? "with what was found, and this" : "with this guess") : []));
  }

  /** What stands beside the last screen: the missing force, where it is drawn; commands can be copied. */
  advising() {
    for (const code of this.stages.next.parentNode.querySelectorAll(".told code")) {
      const button = h("button", { type: "button", class: "quiet", "aria-label": "copy the command", onclick: async () => {
        button.textContent = await navigator.clipboard.writeText(code.textContent).then(() => "copied", () => "select it and copy");
      } }, "copy");
      code.after(" ", button);
    }
  }

  /** The button puts in the last step of the search; where nothing was added to the model, what was found and left out as it is
   *  small, at its size, or the effect that the screen tells of at the smallest that would matter. */
  putting() {
    const { models, begins: step, ranking, effects, verdict } = this.campaign.diagnosis, begins = models.find((m) => m.step === step);
    const known = ranking.filter((r) => this.campaign.effects.some((e) => e.id === r.effect)), told = this.told("put").effect, first = known.find((r) => effects.includes(r.effect)) ?? known.find((r) => r.effect === told) ?? known[0];
    const sizes = first ? this.campaign.effects.find((e) => e.id === first.effect).parameters.map((p) => [p.name, p.delta || p.default]) : [];
    this.with = !same(this.last.values, begins.values) ? this.last.values : first?.values && (effects.length || verdict === "outside") ? first.values : { ...begins.values, ...Object.fromEntries(sizes) };
    this.toggle = h("button", { type: "button", class: "step big", "aria-pressed": "false", onclick: () => { this.app.parting = !this.isIn() && this.parts(); this.app.put({ ...(this.isIn() ? begins.values : this.with) }); this.pressed(); } }, "put it in");
    this.figures = h("p", { class: "counter" }, this.before = h("b", {}, "–"), this.change = h("span", { class: "change" }, " → ", this.after = h("b", {}, "–")), this.of = h("span", {}, " times the noise"));
    this.curve = h("div", { class: "curve" });
    this.stages.put.append(this.toggle, this.figures, this.curve);
  }

  /** Does the button put in what the search did not, so that nobody knows yet where it shows? */
  parts() {
    const { models, begins } = this.campaign.diagnosis;
    return same(this.last.values, models.find((m) => m.step === begins).values);
  }

  /** The shown channel's error in the shown run, noise = 1, before and now. */
  partsBy() {
    const { app } = this, { run, channel } = app.shown, both = [app.before(), app.results[run]];
    const errors = both.map((r) => (r ? byChannel(r)[channel] : NaN));
    return errors.every(Number.isFinite) ? errors : null;
  }

  isIn() {
    return Object.entries(this.with).every(([n, v]) => (this.app.values[n] ?? 0) === v);
  }

  /** Only what is on the open screen; of what follows from values only where it is in sight, as drawing costs time. `rested`:
   *  values rest, and all may be drawn. */
  draw(rested = true) {
    const kind = this.screens[this.at].dataset.kind, stage = this.stages[kind];
    if (kind === "put") return this.drawPut(rested);
    if (!rested) return;
    if (kind === "guess") this.drawGuess();
    if (kind === "errs") stage.replaceChildren(...this.curves(this.app.before(), null));
    if (kind === "next") stage.replaceChildren(...this.drawing(this.app.figures.all.next ? "next" : "missing", stage));
    if (kind === "rivals") {
      const rows = this.told("rivals").bars, { all } = this.app.figures, other = this.campaign.diagnosis.ties.length ? (all.joint ? "joint" : "forest") : rows.length > 1 ? null : "forest", drawn = other ? this.drawing(other, stage) : [];
      stage.replaceChildren(...(drawn.length ? drawn : rows.length > 1 ? [(this.bars ??= this.barred(rows)).place] : []));
      if (!drawn.length) this.bars?.redraw();
    }
  }

  /** The error with each effect that was refitted, as a figure. */
  barred(rows) {
    const { campaign, figures } = this.app, judged = this.app.judged();
    return new Figure(h("figure", { id: "each" }), {
      title: `Error on ${judged}`, subject: () => figures.whole(), file: () => `${campaign.name}-each`, draw: (width, look) => bars(width, look, rows),
      columns: () => ({ "put in": rows.map((r) => r.title), "error, noise = 1": rows.map((r) => r.error) }),
      caption: () => `Error on ${judged} with each of these put in and all values fitted again, in units of what sensor noise alone gives: ${rows.map((r) => `${r.title} ${rms(r.error)}`).join(", ")}.`,
    });
  }

  /** The button as it is now, though the numbers may still come. */
  pressed() {
    const { verdict, effects, ties } = this.campaign.diagnosis, tied = ties.flat(), alone = verdict === "tie" && effects.every((e) => tied.includes(e));
    const it = this.told("put").title.startsWith("Put them") ? "them" : "it", which = alone ? titleOf(this.campaign, effects[0]) : "";
    this.toggle.textContent = which ? `${this.isIn() ? "take out" : "put in"}: ${which}` : this.isIn() ? `take ${it} out again` : `put ${it} in`;
    this.toggle.setAttribute("aria-pressed", this.isIn());
  }

  /** Which error the button moves: on runs held out, but where that does not come down and the one on fitted runs does. */
  shows(from, to) {
    if (!Number.isFinite(this.app.now?.heldout)) return "fit";
    return to.heldout >= from.heldout && from.fit - to.fit > SEEN ? "fit" : "heldout";
  }

  drawPut(rested) {
    const { models, ladder, begins } = this.campaign.diagnosis, start = ladder.find((s) => s.step === begins), key = this.shows(start, ladder.at(-1));
    this.pressed();
    this.of.textContent = ` times the noise${key === "fit" && Number.isFinite(this.app.now?.heldout) ? ", on the fitted runs" : ""}`;
    const own = this.parts() && this.partsBy(); // over all readings such an error hardly moves
    if (own) this.of.textContent = " times the noise, in this run and channel";
    this.before.textContent = rms(own ? own[0] : start?.[key]);
    this.after.textContent = rms(own ? own[1] : this.app.now?.[key]);
    this.change.hidden = same(this.app.values, models.find((m) => m.step === begins).values);
    if (rested || this.seen) this.curve.replaceChildren(...this.curves(this.app.before(), this.app.results[this.app.shown.run]));
  }

  /** How wide a picture on this stage may be. An empty one has no place in its screen's grid, so something stands in it meanwhile. */
  room(stage, most) {
    if (!stage.firstChild) stage.append(h("div"));
    return Math.max(280, Math.min(most, stage.clientWidth || 600));
  }

  /** One of the expert's pictures with its caption, where there is one. */
  drawing(id, stage) {
    const figure = this.app.figures.all[id];
    return figure ? [h("h4", {}, figure.says.title), figure.says.draw(this.room(stage, 760), look()), h("p", { class: "caption" }, figure.says.caption())] : [];
  }

  curves(before, after, name = "model now") {
    const { run: index, channel } = this.app.shown, run = this.campaign.runs[index], record = this.campaign.channels.find((c) => c.name === channel);
    if (!before?.predicted?.[channel]) return [];
    const factor = record.display[0]?.factor ?? 1, scaled = (v) => Array.from(v, (x) => x * factor), there = after?.predicted?.[channel] && after !== before;
    const drawn = [["measured", scaled(run.channels[channel]), "measured", 1.2], there && ["before", scaled(before.predicted[channel]), "before", 1.5, [3, 3]], there ? [name, scaled(after.predicted[channel]), "model", 2] : ["calibrated model", scaled(before.predicted[channel]), "model", 2]].filter(Boolean);
    const edges = this.app.band(...(there ? [after] : [before, null])).map(scaled), width = this.room(this.stages[this.screens[this.at].dataset.kind], 760);
    const shown = there ? after : before, slight = byChannel(before)[channel] < SLIGHT;
    const mean = (result) => smooth(run.time, result.errors[channel]), was = there ? [["before", mean(before), "before", 1.2, [3, 3]]] : [];
    const means = slight ? [{ label: "error ÷ noise", lines: [...was, ["error", mean(shown), "error", 1.5]], height: 90 }] : [], [low, high] = extent(...means.flatMap((m) => m.lines.map((l) => l[1]))), most = Math.max(LEAST, -low, high);
    for (const m of means) m.reach = [-most, most];
    const below = slight ? ` Below it, the mean error over half a second${there ? ", before (dashed) and now" : ""}.` : "";
    return [lines(width, look(), run.time, [run.time[0], run.time.at(-1)], [{ label: labelled(record), lines: drawn, edges, height: 190 }, ...means]), h("p", { class: "caption" }, `${capital(channelOf(channel))} in ${runOf(run)}. The band holds 95 of 100 readings where the model is right.${below}`)];
  }
}
