// The page: what the reader sets, the workers' answers, and the charts that follow.

import { Charts } from "page/charts";
import { Controls } from "page/controls";
import { byId, decoded, h } from "page/dom";
import { together } from "page/errors";
import { evidence } from "page/evidence";
import { rms } from "page/numbers";
import { Pool } from "page/pool";
import { Trajectory } from "page/trajectory";

const REST = 80; // ms without a change after which the numbers are made exact

class App {
  constructor(campaign) {
    this.campaign = campaign;
    this.results = [];
    this.timings = [];
    this.pending = this.running = null;
    this.shown = this.firstShown();
    evidence(campaign);
    this.pool = new Pool(byId("worker").textContent, campaign, (run, result) => this.heard(run, result));
    this.charts = new Charts(campaign, (run, channel) => this.show(run, channel));
    this.trajectory = new Trajectory(byId("path"), campaign);
    this.controls = new Controls(byId("controls"), campaign, (values) => this.set(values));
    this.pick = this.picker();
    this.set(this.controls.values);
  }

  /** The run that opens: held out, or the first; the channel is decided by the first exact errors. */
  firstShown() {
    const run = this.campaign.runs.findIndex((r) => r.role === "holdout");
    const at = Math.max(run, 0);
    return { run: at, channel: Object.keys(this.campaign.runs[at].channels)[0], chosen: false };
  }

  /** Simulate everything with these values: quickly now, exactly once they rest. */
  set(values) {
    this.values = { ...values };
    this.settled = false;
    clearTimeout(this.resting);
    if (this.running && !this.running.exact) this.pending = true;
    else this.ask(this.results.length < this.campaign.runs.length);
  }

  ask(exact) {
    const rest = this.campaign.runs.map((_, i) => i).filter((i) => i !== this.shown.run);
    this.pending = false;
    this.running = { exact, left: new Set([this.shown.run, ...rest]), began: performance.now(), one: null };
    this.say(exact ? "making the numbers exact …" : "simulating …", "busy");
    this.pool.ask([...this.running.left], this.values, exact);
  }

  heard(run, result) {
    const { running } = this;
    running.left.delete(run);
    if (result.error) this.failed = `${this.campaign.runs[run].name}: ${result.error}`;
    else this.results[run] = result;
    if (run === this.shown.run && !result.error) {
      this.drawRun();
      running.one = performance.now() - running.began;
    }
    if (!running.left.size) this.complete();
  }

  complete() {
    const { exact, began, one } = this.running;
    this.running = null;
    if (this.failed) {
      this.say(this.failed, "failed");
      this.failed = null;
    } else {
      this.opened ??= [...this.results];
      if (!this.shown.chosen) this.openWorst();
      this.drawAll(exact);
      this.say(exact ? "exact, as wheelchair compare" : "about, while it moves", exact ? "exact" : "quick");
      requestAnimationFrame(() => setTimeout(() => { this.timings.push({ exact, one, all: performance.now() - began }); this.settled = exact; }));
    }
    if (this.pending) this.ask(false);
    else if (!exact) this.resting = setTimeout(() => this.ask(true), REST);
  }

  /** The largest error of a held-out run is what the reader sees first. */
  openWorst() {
    let worst = -1;
    this.results.forEach((r, i) => {
      if (this.campaign.runs[i].role !== this.campaign.runs[this.shown.run].role) return;
      for (const [c, s] of Object.entries(r.squares)) {
        if (s / r.counts[c] > worst) [worst, this.shown] = [s / r.counts[c], { run: i, channel: c, chosen: true }];
      }
    });
    this.pick.show(this.shown);
    this.drawRun();
  }

  show(run, channel) {
    const there = this.campaign.runs[run].channels;
    const wanted = channel ?? this.shown.channel;
    this.shown = { run, channel: wanted in there ? wanted : Object.keys(there)[0], chosen: true };
    this.pick.show(this.shown);
    this.drawRun();
    this.charts.where(this.results, this.shown);
  }

  drawRun() {
    const result = this.results[this.shown.run];
    if (!result) return;
    const before = this.opened?.[this.shown.run];
    this.charts.overlay(this.shown, result, before);
    this.trajectory.show(this.shown.run, result, before);
  }

  /** `rested`: also what takes long to sort. */
  drawAll(rested = true) {
    const { runs } = this.campaign, now = { fit: together(runs, this.results, "fit"), heldout: together(runs, this.results, "holdout") };
    byId("now-fit").textContent = rms(now.fit);
    byId("now-heldout").textContent = rms(now.heldout);
    this.now = now;
    this.charts.staircase(now);
    this.charts.where(this.results, this.shown);
    if (rested) this.charts.regimes(this.results);
  }

  redraw() {
    if (this.opened) this.drawAll();
    this.drawRun();
  }

  say(words, state) {
    const status = byId("status");
    status.textContent = words;
    status.dataset.state = state;
  }

  picker() {
    const run = h("select", { id: "run", onchange: () => this.show(Number(run.value), channel.value) });
    const channel = h("select", { id: "channel", onchange: () => this.show(Number(run.value), channel.value) });
    this.campaign.runs.forEach((r, i) => run.append(h("option", { value: i }, r.role === "holdout" ? `${r.name} (held out)` : r.name)));
    byId("pick").append(h("label", {}, "Run ", run), h("label", {}, "Channel ", channel));
    const show = (shown) => {
      run.value = shown.run;
      channel.replaceChildren(...Object.keys(this.campaign.runs[shown.run].channels).map((c) => h("option", { value: c }, c.replaceAll("_", " "))));
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
  });
  media.addEventListener("change", redraw);
}

const app = new App(decoded(JSON.parse(byId("content").textContent)));
themed(() => {
  app.charts.recolour();
  app.redraw();
});
let width = innerWidth, settling;
addEventListener("resize", () => {
  clearTimeout(settling);
  if (innerWidth !== width) settling = setTimeout(() => app.redraw((width = innerWidth)), REST);
});
window.report = app; // for whoever wants to script the page
