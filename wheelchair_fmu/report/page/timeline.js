// One time for everything that is drawn against it: two charts by uPlot, the scene, and a row of readings for every channel.

import { NARROW, h, write } from "page/dom";
import { look, present, ticked } from "page/draw";
import { beside, display, toPlace, unitText } from "page/numbers";
import { channelOf } from "page/words";

const AXIS = 62; // px left of every chart, so that their times stand above one another
const SPEEDS = [0.25, 0.5, 1, 2, 4];
const DENSE = 1.5; // px between two points of a smooth curve
const STILL = matchMedia("(prefers-reduced-motion: reduce)");

/** A series as the charts take it: null where there is no sample. */
const gapped = (values) => (values.some(Number.isNaN) ? Array.from(values, (v) => (Number.isNaN(v) ? null : v)) : values);

/** What uPlot draws of a simulated curve: it is smooth, so that fewer points than samples do. */
function smooth(plot, series, from, to) {
  const path = new Path2D(), [xs, ys] = [plot.data[0], plot.data[series]], step = thinned(plot, from, to);
  let pen = "moveTo";
  for (let i = from; i <= to; i = i < to ? Math.min(i + step, to) : to + 1) {
    if (!Number.isFinite(ys[i])) { pen = "moveTo"; continue; }
    path[pen](plot.valToPos(xs[i], "x", true), plot.valToPos(ys[i], "y", true));
    pen = "lineTo";
  }
  return { stroke: path };
}

const thinned = (plot, from, to) => Math.max(1, Math.floor(((to - from) * DENSE) / plot.width));

/** The last sample that a series has at a place, or the place itself where it has none before. */
function latest(values, at) {
  for (let k = at; k >= 0; k--) if (!Number.isNaN(values[k])) return k;
  return at;
}

export class Timeline {
  /** Curves and player go into `place`, readings `beside`. `choose(channel)` is called from the readings, `moved()` when time, zoom or speed have been set by hand. */
  constructor(place, beside, campaign, scene, choose, moved) {
    Object.assign(this, { campaign, scene, choose, moved });
    this.at = this.from = this.to = 0;
    this.playing = false;
    this.charts = [h("div", { class: "chart" }), h("div", { class: "chart" })];
    place.append(h("div", { class: "curves" }, this.key = h("p", { class: "key" }), this.charts), this.player());
    this.readings = h("table", { class: "readings" });
    const placed = () => (NARROW.matches ? place : beside).append(this.readings); // on a phone nothing stands between the chair and the curves
    placed();
    NARROW.addEventListener("change", placed);
    this.colours();
    this.plots = [];
    this.drawn = new Map(); // by series that do not change: as charts take them
  }

  player() {
    const button = (words, label, act) => h("button", { type: "button", class: "quiet", onclick: act, "aria-label": label }, words);
    this.play = button("▶ play", "play", () => this.toggle());
    this.scrub = h("input", { type: "range", min: 0, max: 1, step: "any", value: 0, "aria-label": "time" });
    this.scrub.addEventListener("input", () => { this.stop(); this.go(this.scrub.valueAsNumber); this.moved(); });
    this.speed = h("select", { "aria-label": "speed of playing" }, SPEEDS.map((s) => h("option", { value: s, selected: s === 1 }, `${s}×`)));
    this.loop = h("input", { type: "checkbox", id: "loop" });
    for (const one of [this.speed, this.loop]) one.addEventListener("change", () => this.moved());
    this.clock = h("output", { class: "clock" });
    this.whole = button("whole run", "show the whole run", () => { this.zoom(this.time[0], this.time.at(-1)); this.moved(); });
    return h("div", { class: "player" }, this.play, this.scrub, this.clock, this.speed, h("label", { for: "loop" }, this.loop, " loop"), this.whole);
  }

  colours() {
    this.look = look();
  }

  /** A run: time, zoom and place begin anew, unless `kept` {t, from, to} says otherwise. */
  begin(run, kept) {
    this.run = run;
    this.time = run.time;
    this.stop();
    [this.from, this.to] = [kept?.from ?? this.time[0], kept?.to ?? this.time.at(-1)];
    if (!(this.from < this.to)) [this.from, this.to] = [this.time[0], this.time.at(-1)];
    this.at = Math.min(Math.max(kept?.t ?? this.time[0], this.time[0]), this.time.at(-1));
    if (SPEEDS.includes(kept?.speed)) this.speed.value = kept.speed;
    if (kept?.loop) this.loop.checked = true;
    [this.scrub.min, this.scrub.max] = [this.time[0], this.time.at(-1)];
    this.drawn.clear();
    this.cells = Object.keys(run.channels).map((name, k) => {
      const { factor, unit } = display(this.campaign.channels.find((c) => c.name === name)), read = (v) => beside(toPlace(v * factor, (run.noise.sd[k] * factor) / 3), unitText(unit));
      return { name, read, measured: h("span"), model: h("span"), error: h("span") };
    });
    this.readings.replaceChildren(h("caption", {}, "What every channel reads at the cursor"),
      h("thead", {}, h("tr", {}, ["channel", "measured", "model", "error ÷ noise"].map((t) => h("th", { scope: "col" }, t)))),
      h("tbody", {}, this.cells.map((c) => h("tr", { "data-channel": c.name }, h("th", { scope: "row" },
        h("button", { type: "button", class: "plain", onclick: () => this.choose(c.name) }, channelOf(c.name))), [c.measured, c.model, c.error].map((cell) => h("td", {}, cell))))));
  }

  /** Draw `channel` of the run, from `result` and the same `before`; `pinned` is [[label, result], ...], `band` [low, high] about
   *  the model. */
  show(channel, result, before, pinned, band) {
    const record = this.campaign.channels.find((c) => c.name === channel), { unit, factor } = display(record);
    const scaled = (series) => (factor === 1 ? series : series.map((v) => v * factor));
    const once = (series) => this.drawn.get(series) ?? this.drawn.set(series, scaled(series)).get(series);
    Object.assign(this, { result, channel });
    this.lines = [["measured", once(this.run.channels[channel]), "measured", 1], ...(before && before !== result ? [["before", once(before.predicted[channel]), "before", 1.25, [2, 3]]] : []),
      ...pinned.map(([label, r]) => [label, once(r.predicted[channel]), `pin-${label.toLowerCase()}`, 1.25, [8, 3, 2, 3]]), ["model", scaled(result.predicted[channel]), "model", 2]];
    this.edges = band.map(scaled);
    this.errors = result.errors[channel];
    this.unit = `${channelOf(channel)} [${unitText(unit) || "1"}]`;
    this.drawCurves();
    for (const row of this.readings.tBodies[0].rows) row.toggleAttribute("aria-current", row.dataset.channel === channel);
    this.place();
  }

  drawCurves() {
    const shape = this.lines.map(([name]) => name).join("|") + this.unit, data = [[this.time, ...this.lines.map(([, v]) => gapped(v))], [this.time, gapped(this.errors)]];
    if (shape !== this.shape || !this.plots.length) return this.build(shape, data);
    this.plots.forEach((plot, i) => plot.batch(() => { plot.setData(data[i], false); plot.setScale("x", { min: this.from, max: this.to }); }));
  }

  build(shape, data) {
    this.shape = shape;
    for (const plot of this.plots) plot.destroy();
    this.marks = null;
    const colour = (name) => () => this.look[name];
    const series = [this.lines.map(([, , name, width, dash]) => ({ stroke: colour(name), width, dash, points: { show: false }, ...(name === "measured" ? { gaps: this.gaps } : { paths: smooth }) })), [{ stroke: colour("error"), width: 1, points: { show: false }, gaps: this.gaps }]];
    this.plots = [this.unit, "error ÷ noise"].map((label, i) => new uPlot(this.options(i, label, series[i]), data[i], this.charts[i]));
    this.marks = this.plots.map((plot) => plot.over.appendChild(h("div", { class: "now-line" })));
    this.key.replaceChildren(...this.lines.map(([name, , colour, , dash]) => h("span", {}, h("i", { style: `border-top:${dash ? "2px dashed" : "3px solid"} var(--${colour})` }), name)), h("span", {}, h("i", { class: "band" }), "95 % band"));
  }

  options(index, label, series) {
    const axis = { stroke: () => this.look.faint, grid: { stroke: () => this.look.line, width: 1 }, ticks: { stroke: () => this.look.line, width: 1, size: 4 }, font: "12px system-ui, sans-serif" };
    return {
      ...this.size(index), padding: [8, 6, index ? 0 : 8, 0], legend: { show: false }, series: [{}, ...series],
      cursor: { sync: { key: "time" }, drag: { x: true, y: false, dist: 6, setScale: false }, points: { size: 6 }, y: false },
      scales: { x: { time: false, range: () => [this.from, this.to] }, y: { range: index ? (_, low, high) => { const most = 1.05 * Math.max(4, -low || 0, high || 0); return [-most, most]; } : undefined } },
      axes: [{ ...axis, show: index === 1, size: 40, label: index ? "time [s]" : undefined, labelSize: 18, labelFont: "12px system-ui, sans-serif" },
        { ...axis, size: AXIS - 18, space: index ? 24 : 36, label, labelSize: 18, labelFont: "12px system-ui, sans-serif", values: (_, vs) => ticked(vs).map(([, words]) => words) }],
      hooks: {
        setSelect: [(plot) => this.selected(plot)],
        draw: [() => this.mark()],
        drawClear: [(plot) => (index ? this.noise(plot) : this.band(plot))],
        init: [(plot) => {
          plot.over.addEventListener("dblclick", () => this.whole.click());
          plot.over.addEventListener("mousemove", ({ clientX }) => { if (!this.playing) this.go(plot.posToVal(clientX - plot.over.getBoundingClientRect().left, "x")); });
        }],
      },
    };
  }

  /** Of the gaps between samples (px), those in which the series itself pauses. */
  gaps = (plot, series, from, to, found) => {
    if (!found.length) return found;
    const { lapse } = present(this.time, plot.data[series].map((v) => v ?? NaN)), { min, max } = plot.scales.x, scale = (max - min) / plot.bbox.width;
    return found.filter(([a, b]) => (b - a) * scale > lapse);
  };

  size(index) {
    return { width: Math.max(240, this.charts[0].clientWidth), height: NARROW.matches ? (index ? 150 : 196) : index ? 230 : 400 };
  }

  /** Where 95 % of readings lie if the model is right; the scale is that of the curves. */
  band(plot) {
    const { ctx, bbox: { left, top, width, height } } = plot, { time } = this, [low, high] = this.edges;
    const from = Math.max(0, time.findLastIndex((t) => t <= this.from)), to = Math.max(from, time.findLastIndex((t) => t <= this.to)), step = thinned(plot, from, to);
    ctx.save();
    ctx.beginPath(); ctx.rect(left, top, width, height); ctx.clip();
    ctx.beginPath();
    for (let i = from; i <= to; i += step) ctx.lineTo(plot.valToPos(time[i], "x", true), plot.valToPos(low[i], "y", true));
    for (let i = from + step * Math.floor((to - from) / step); i >= from; i -= step) ctx.lineTo(plot.valToPos(time[i], "x", true), plot.valToPos(high[i], "y", true));
    ctx.fillStyle = this.look.band;
    ctx.fill();
    ctx.restore();
  }

  /** Where 95 % of a perfect model's errors lie. */
  noise(plot) {
    const [top, low] = [2, -2].map((v) => plot.valToPos(v, "y", true)), { left, width } = plot.bbox;
    plot.ctx.fillStyle = this.look.band;
    plot.ctx.fillRect(left, top, width, low - top);
  }

  /** What was drawn over with the pointer is shown whole. */
  selected(plot) {
    const { left, width } = plot.select;
    if (width < 6) return;
    const [from, to] = [left, left + width].map((p) => plot.posToVal(p, "x"));
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.zoom(from, to);
    this.moved();
  }

  zoom(from, to) {
    [this.from, this.to] = [from, to];
    for (const plot of this.plots) plot.setScale("x", { min: from, max: to });
    this.place();
  }

  go(t) {
    this.at = Math.min(Math.max(t, this.time[0]), this.time.at(-1));
    this.place();
  }

  /** The sample at the cursor. */
  get sample() {
    let low = 0, high = this.time.length - 1;
    while (low < high) { const middle = (low + high) >> 1; if (this.time[middle] < this.at) low = middle + 1; else high = middle; }
    return low;
  }

  /** The cursor's line in both charts; they call this once they have another scale or size, too. */
  mark() {
    const inside = this.at >= this.from && this.at <= this.to;
    this.marks?.forEach((mark, k) => { mark.style.transform = inside ? `translateX(${this.plots[k].valToPos(this.at, "x")}px)` : "translateX(-9999px)"; });
  }

  place() {
    if (!this.result) return;
    const i = this.sample;
    this.mark();
    for (const { name, read, measured, model, error } of this.cells) {
      const k = latest(this.run.channels[name], i);
      write(measured, read(this.run.channels[name][k]));
      write(model, read(this.result.predicted[name][i]));
      write(error, toPlace(this.result.errors[name][k], 0.1));
    }
    const said = `${this.at.toFixed(2)} s`;
    write(this.clock, said);
    if (this.scrub.valueAsNumber !== this.at) {
      this.scrub.value = this.at;
      this.scrub.setAttribute("aria-valuetext", said);
    }
    this.scene.draw(i);
  }

  /** How it is played, for the address, where that is not as it begins. */
  pace() {
    return { ...(this.speed.value === "1" ? {} : { speed: Number(this.speed.value) }), ...(this.loop.checked ? { loop: true } : {}) };
  }

  toggle() {
    if (this.playing) return this.stop(true);
    this.playing = true;
    this.play.textContent = "❚❚ pause";
    this.play.setAttribute("aria-label", "pause");
    if (this.at >= this.to - 1e-6 || this.at < this.from) this.at = this.from;
    let before = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      const step = ((now - before) / 1000) * Number(this.speed.value);
      if (!STILL.matches || step > 0.25 * Number(this.speed.value)) { // reduced motion: four pictures a second
        this.at += step;
        before = now;
        if (this.at >= this.to) { if (this.loop.checked) this.at = this.from; else return this.stop(true, (this.at = this.to)); }
        this.place();
      }
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  stop(told = false) {
    this.playing = false;
    this.play.textContent = "▶ play";
    this.play.setAttribute("aria-label", "play");
    if (this.result) this.place();
    if (told) this.moved();
  }

  resize() {
    this.plots.forEach((plot, i) => plot.setSize(this.size(i)));
    this.place();
  }

  recolour() {
    this.colours();
    for (const plot of this.plots) plot.redraw(false, true);
  }
}
