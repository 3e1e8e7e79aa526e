// The path from above, with the chair going along it. Drawn by hand: the chair must turn with every frame.

import { csv, h, save } from "page/dom";
import { figure, image } from "page/figure";

const NS = "http://www.w3.org/2000/svg";
const MARGIN = 34;
const WIDE = 560; // px
const SMALLEST = 46; // of the chair on paper

const svg = (tag, attributes = {}, ...children) => {
  const made = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
};

export class Trajectory {
  constructor(place, campaign) {
    this.campaign = campaign;
    this.at = 0;
    this.playing = false;
    const part = figure(place, "The path from above", {
      PNG: () => image(this.svg, `${this.name()}-path.png`), SVG: () => image(this.svg, `${this.name()}-path.svg`),
      CSV: () => save(`${this.name()}-path.csv`, csv(this.columns())),
    });
    this.svg = svg("svg", { class: "path", role: "img" });
    this.play = h("button", { type: "button", class: "quiet", onclick: () => this.toggle() }, "▶ play");
    this.scrub = h("input", { type: "range", min: 0, max: 1, step: "any", value: 0, "aria-label": "time along the path" });
    this.clock = h("output", { class: "clock" });
    this.scrub.addEventListener("input", () => { this.stop(); this.at = this.scrub.valueAsNumber; this.place(); });
    part.append(this.svg, h("div", { class: "player" }, this.play, this.scrub, this.clock));
    this.parts();
  }

  name() {
    return this.campaign.runs[this.run].name;
  }

  parts() {
    this.key = svg("g");
    this.grid = svg("g", { class: "grid" });
    this.before = svg("path", { class: "before" });
    this.measured = svg("path", { class: "measured" });
    this.path = svg("path", { class: "model" });
    this.chair = svg("g", { class: "chair" });
    const { a, b, t_r: rear, t_f: front, R } = this.campaign.geometry;
    const wheel = (x, y, length, width) => svg("rect", { x: y - width / 2, y: -x - length / 2, width, height: length, rx: width / 2, class: "wheel" });
    this.casters = [-1, 1].map((side) => svg("g", {}, svg("rect", { x: -0.015, y: 0, width: 0.03, height: 0.12, rx: 0.015, class: "wheel" })));
    this.casters.forEach((c, i) => { c.where = [(i ? front : -front) / 2, -a]; });
    this.chair.append(svg("path", { class: "frame", d: `M${-rear / 2} ${b}H${rear / 2}L${front / 2} ${-a}H${-front / 2}Z` }),
      wheel(-b, -rear / 2, 2 * R, 0.04), wheel(-b, rear / 2, 2 * R, 0.04), ...this.casters, svg("circle", { r: 0.03, class: "cm" }));
    this.svg.append(this.grid, this.before, this.measured, this.path, this.chair, this.key);
  }

  /** `before` is the same run as the page opened with. */
  show(run, result, before) {
    const { results } = result, time = this.campaign.runs[run].time;
    if (run !== this.run) { this.run = run; this.at = 0; this.scrub.value = 0; this.reckoned = reckoned(this.campaign.runs[run], results); }
    this.model = { x: results["chair.x"], y: results["chair.y"], psi: results["chair.psi"], fl: results["caster.fl"], fr: results["caster.fr"] };
    this.time = time;
    this.was = before && before !== result ? { x: before.results["chair.x"], y: before.results["chair.y"] } : null;
    this.svg.setAttribute("aria-label", `Path of the chair in ${this.name()}, ${(time.at(-1) - time[0]).toFixed(0)} s, from (0, 0) to ${last(this.model.x)} m forward and ${last(this.model.y)} m to the right`);
    this.fit();
    this.before.setAttribute("d", this.was ? line(this.was, this) : "");
    this.path.setAttribute("d", line(this.model, this));
    this.measured.setAttribute("d", this.reckoned ? line(this.reckoned, this) : "");
    this.place();
  }

  /** Scale and offset that show all paths whole. Forward lies to the right where there is width for it, and up where not. */
  fit() {
    this.width = Math.max(300, this.svg.parentNode.clientWidth);
    this.lying = this.width > WIDE;
    const every = [this.model, this.reckoned, this.was].filter(Boolean), room = 0.6; // the chair itself
    const [xs, ys] = ["x", "y"].map((c) => extent(every.flatMap((p) => extent([...p[c]]))));
    const [[left, right], [top, bottom]] = this.lying ? [xs, ys] : [ys, [-xs[1], -xs[0]]];
    const across = right - left + 2 * room, down = bottom - top + 2 * room, inner = this.width - 2 * MARGIN, frame = 2 * MARGIN + 20;
    const most = Math.min(460, 0.95 * this.width);
    this.height = this.lying ? Math.min(most, Math.max(220, (down * inner) / across + frame)) : most;
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    this.scale = Math.min(inner / across, (this.height - frame) / down);
    this.origin = [this.width / 2 - (this.scale * (left + right)) / 2, this.height / 2 - 2 - (this.scale * (top + bottom)) / 2];
    const step = [0.5, 1, 2, 5, 10, 20, 50, 100].find((s) => s * this.scale > 45) ?? 200, lines = [];
    const across0 = (u) => this.origin[0] + this.scale * u, down0 = (v) => this.origin[1] + this.scale * v;
    for (let u = Math.ceil((MARGIN - this.origin[0]) / this.scale / step) * step; across0(u) < this.width - MARGIN / 2; u += step)
      lines.push(svg("path", { d: `M${across0(u).toFixed(1)} ${MARGIN}V${this.height - 36}` }), text(across0(u), this.height - 21, u, "middle"));
    for (let v = Math.ceil((MARGIN + 4 - this.origin[1]) / this.scale / step) * step; down0(v) < this.height - MARGIN - 6; v += step)
      lines.push(svg("path", { d: `M${MARGIN - 4} ${down0(v).toFixed(1)}H${this.width - 8}` }), text(MARGIN - 8, down0(v) + 4, this.lying ? v : 0 - v, "end"));
    this.grid.replaceChildren(...lines);
    this.magnified = Math.max(1, SMALLEST / (this.scale * 0.7));
    this.legend();
  }

  legend() {
    const { x, y } = this.campaign.runs[this.run].channels, lines = [["model", "model"]];
    if (this.was) lines.push(["before", "as the page opened"]);
    if (this.reckoned) lines.push(["measured", x && y ? "tracked" : "from wheel speeds and yaw rate"]);
    let [at, row] = [8, 14];
    const parts = lines.flatMap(([cls, words]) => {
      const length = 46 + 6.3 * words.length;
      if (at + length > this.width) [at, row] = [8, row + 15];
      const made = [svg("path", { class: cls, d: `M${at} ${row - 4}h24` }), text(at + 30, row, words, "start")];
      at += length;
      return made;
    });
    const size = this.magnified > 1.05 ? (this.lying ? `; the chair is drawn ${this.magnified.toFixed(1)} times its size` : `; chair × ${this.magnified.toFixed(1)}`) : "";
    const axes = this.lying ? "metres forward; downwards: metres to the right" : "metres to the right; upwards: forward";
    this.key.replaceChildren(...parts, text(this.width / 2, this.height - 4, axes + size, "middle"));
  }

  /** Where metres forward and to the right are on paper. */
  on(x, y) {
    const [across, down] = this.lying ? [x, y] : [y, -x];
    return [this.origin[0] + this.scale * across, this.origin[1] + this.scale * down];
  }

  place() {
    const n = this.time.length, t = this.time[0] + this.at * (this.time[n - 1] - this.time[0]);
    let i = this.time.findIndex((v) => v >= t);
    if (i < 0) i = n - 1;
    const deg = 180 / Math.PI, { x, y, psi, fl, fr } = this.model;
    const [across, down] = this.on(x[i], y[i]), turned = psi[i] * deg + (this.lying ? 90 : 0);
    this.chair.setAttribute("transform", `translate(${across.toFixed(2)} ${down.toFixed(2)}) rotate(${turned.toFixed(2)}) scale(${(this.scale * this.magnified).toFixed(3)})`);
    [fl, fr].forEach((angle, k) => {
      const [px, py] = this.casters[k].where;
      this.casters[k].setAttribute("transform", `translate(${px} ${py}) rotate(${(angle[i] * deg).toFixed(2)})`);
    });
    this.clock.textContent = `${(t - this.time[0]).toFixed(1)} s`;
    this.scrub.setAttribute("aria-valuetext", this.clock.textContent);
  }

  toggle() {
    if (this.playing) return this.stop();
    this.playing = true;
    this.play.textContent = "❚❚ pause";
    if (this.at >= 1) this.at = 0;
    let before = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      this.at = Math.min(1, this.at + (now - before) / 1000 / (this.time.at(-1) - this.time[0]));
      before = now;
      this.scrub.value = this.at;
      this.place();
      if (this.at < 1) requestAnimationFrame(frame);
      else this.stop();
    };
    requestAnimationFrame(frame);
  }

  stop() {
    this.playing = false;
    this.play.textContent = "▶ play";
  }

  columns() {
    const { x, y, psi } = this.model;
    return { "time [s]": this.time, "x [m]": x, "y [m]": y, "psi [rad]": psi, ...(this.reckoned ? { "x reckoned [m]": this.reckoned.x, "y reckoned [m]": this.reckoned.y } : {}) };
  }
}

/** Where the sensors say the chair went: tracked, or reckoned from wheel speeds and yaw rate; null where neither is there. */
function reckoned(run, results) {
  const { x, y, wheel_speed_l: l, wheel_speed_r: r, yaw_rate: turn } = run.channels, { time } = run;
  if (x && y) return { x, y };
  const speed = (i) => (l && r ? (l[i] + r[i]) / 2 : (l ?? r)?.[i]);
  if (!turn || speed(0) === undefined) return null;
  const out = { x: new Float64Array(time.length), y: new Float64Array(time.length) };
  let psi = results["chair.psi"][0];
  [out.x[0], out.y[0]] = [results["chair.x"][0], results["chair.y"][0]];
  for (let i = 1; i < time.length; i++) {
    const dt = time[i] - time[i - 1], w = turn[i - 1] || 0, v = speed(i - 1) || 0;
    psi += (w * dt) / 2;
    out.x[i] = out.x[i - 1] + v * Math.cos(psi) * dt;
    out.y[i] = out.y[i - 1] + v * Math.sin(psi) * dt;
    psi += (w * dt) / 2;
  }
  return out;
}

function line({ x, y }, frame) {
  const step = Math.max(1, Math.floor(x.length / 600)), parts = [];
  for (let i = 0; i < x.length; i += step) if (!Number.isNaN(x[i] + y[i])) parts.push(frame.on(x[i], y[i]).map((v) => v.toFixed(1)).join(" "));
  return parts.length ? `M${parts.join("L")}` : "";
}

const extent = (values) => [Math.min(...values.filter(Number.isFinite)), Math.max(...values.filter(Number.isFinite))];
const last = (series) => series.at(-1).toFixed(1);
const text = (x, y, value, anchor) => Object.assign(svg("text", { x, y, "text-anchor": anchor }), { textContent: typeof value === "number" ? String(Number(value.toFixed(6))).replace("-", "−") : value });
