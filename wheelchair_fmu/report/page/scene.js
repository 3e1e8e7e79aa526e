// The chair from above on a canvas: the whole path, and close by the model's chair with the measured one as a ghost, its wheels
// and casters turning, arrows of what pushes it, and what each wheel carries.

import { NARROW, h, sized, write } from "page/dom";
import { broken, extent, long, round, svg, text, tick } from "page/draw";
import { Pen } from "page/pen";

const ARROW = { push: 1.1, tyre: 1.1, missing: 11, body: 2 }; // px per N; what is missing is small; of the body per N s
const CLOSE = 1.5; // m across the close view
const LETTERS = 11, LINE = 12; // px of words at a wheel, and from one line of them to the next
const MOST = 500; // labels that are kept
const SKETCH = 300; // units of drawing that the close view is high in a file, at most
const LOW = 184; // px high on a phone, so that the chair, the player and the curves are on one screen

export class Scene {
  constructor(place, campaign) {
    this.geometry = campaign.geometry;
    this.canvas = h("canvas", { class: "scene", role: "img" });
    this.paths = h("canvas", { "aria-hidden": "true" }); // the overview, which only changes with the run and the model
    this.dots = ["measured", "model"].map((name) => h("i", { class: "dot", style: `background:var(--${name})` }));
    this.key = h("ul", { class: "legend" });
    this.amounts = Object.fromEntries(["missing", "body", "strokes"].map((of) => [of, h("b", { class: of })])); // in the legend
    this.limits = h("p", { class: "limits", hidden: true });
    place.append(h("div", { class: "scenery" }, this.paths, this.canvas, this.dots), this.limits, this.key);
    this.room = sized(place);
  }

  /** `motion` is {time, model, measured, before, results, inputs, friction, rolled, lacking}; see app.js. */
  show(motion, look, name) {
    Object.assign(this, { motion, look });
    const { model } = motion;
    this.canvas.setAttribute("aria-label", `The chair from above in ${name}: it goes ${round(model.x.at(-1))} m forward and ${round(model.y.at(-1))} m to the right in ${round(motion.time.at(-1) - motion.time[0])} s`);
    this.fit();
    this.trace();
    this.legend();
    const beyond = outside(motion);
    this.limits.hidden = !beyond;
    write(this.limits, beyond);
  }

  fit() {
    const width = Math.max(260, this.room()[0]), height = NARROW.matches ? LOW : Math.round(Math.min(536, Math.max(316, width * 1.45 - 84))), scale = devicePixelRatio || 1;
    const { model, measured, before } = this.motion, every = [model, measured, before].filter(Boolean);
    const [xs, ys] = ["x", "y"].map((c) => extent(...every.map((p) => p[c])));
    const lying = xs[1] - xs[0] > ys[1] - ys[0];
    if (this.width !== width || this.height !== height || this.scale !== scale || this.lying !== lying) {
      Object.assign(this, { width, height, scale, lying });
      const part = 0.36, [w, high] = lying ? [width, Math.round(height * part)] : [Math.round(width * part), height];
      this.over = { w, h: high };
      this.near = lying ? { w: width, h: height - high } : { w: width - w, h: height };
      for (const [c, { w, h }] of [[this.paths, this.over], [this.canvas, this.near]]) {
        [c.width, c.height] = [Math.round(w * scale), Math.round(h * scale)];
        Object.assign(c.style, { width: `${w}px`, height: `${h}px` });
      }
      Object.assign(this.canvas.style, { left: `${lying ? 0 : w}px`, top: `${lying ? high : 0}px` });
      this.canvas.parentNode.style.height = `${height}px`;
    }
    const [[left, right], [top, bottom]] = lying ? [xs, ys] : [ys, [-xs[1], -xs[0]]], room = 0.5, edge = 26;
    this.zoom = Math.min((this.over.w - 2 * edge) / (right - left + 2 * room), (this.over.h - 2 * edge) / (bottom - top + 2 * room));
    this.middle = [(left + right) / 2, (top + bottom) / 2];
  }

  /** Right and down on paper of metres forward and to the right. */
  turned(x, y) {
    return this.lying ? [x, y] : [y, -x];
  }

  overview(x, y) {
    const [right, down] = this.turned(x, y), { over } = this;
    return [over.w / 2 + this.zoom * (right - this.middle[0]), over.h / 2 + this.zoom * (down - this.middle[1])];
  }

  trace() {
    const c = this.paths.getContext("2d"), { look, over, motion } = this;
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    c.clearRect(0, 0, over.w, over.h);
    c.fillStyle = look.faint;
    c.font = "11px system-ui, sans-serif";
    const metres = [1, 2, 5, 10, 20, 50].find((m) => m * this.zoom > 30) ?? 100, at = [10, over.h - 10];
    c.strokeStyle = look.faint;
    c.lineWidth = 1.5;
    c.beginPath(); c.moveTo(...at); c.lineTo(at[0] + metres * this.zoom, at[1]); c.stroke();
    c.fillText(`${metres} m`, at[0], at[1] - 5);
    const strokes = [[motion.before, look.before, 1.5, [2, 3]], [motion.measured, look.measured, 2.5, []], [motion.model, look.model, 2, [7, 4]]];
    for (const [path, colour, width, dash] of strokes) {
      if (!path) continue;
      c.strokeStyle = colour; c.lineWidth = width; c.setLineDash(dash);
      c.beginPath();
      const step = Math.max(1, Math.floor(path.x.length / 500));
      for (let i = 0, pen = false; i < path.x.length; i += step) {
        if (!Number.isFinite(path.x[i] + path.y[i])) { pen = false; continue; }
        c[pen ? "lineTo" : "moveTo"](...this.overview(path.x[i], path.y[i]));
        pen = true;
      }
      c.stroke();
    }
    c.setLineDash([]);
  }

  /** All of it at sample `i`. */
  draw(i) {
    const c = this.canvas.getContext("2d"), { motion, near } = this, { model, measured } = motion;
    if (!(near.w > 0)) return;
    [measured, model].forEach((p, k) => {
      const there = p && Number.isFinite(p.x[i] + p.y[i]), [x, y] = there ? this.overview(p.x[i], p.y[i]) : [-99, -99];
      this.dots[k].style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    });
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    c.clearRect(0, 0, near.w, near.h);
    this.paint(c, i);
    this.says(i);
  }

  /** The chair at sample `i`, on a canvas or by a pen. */
  paint(c, i) {
    const { motion: { model, measured }, look, near } = this;
    this.floor(c, i);
    const size = Math.min(near.w, near.h) / CLOSE, pose = (p) => {
      const [right, down] = this.turned(p.x[i] - model.x[i], p.y[i] - model.y[i]);
      return [near.w / 2 + size * right, near.h / 2 + size * down, p.psi[i] + (this.lying ? Math.PI / 2 : 0)];
    };
    if (measured && Number.isFinite(measured.x[i] + measured.psi[i])) this.chair(c, i, pose(measured), size, look.measured, true);
    this.chair(c, i, pose(model), size, look.model, false);
    this.arrows(c, i, pose(model), size);
    this.loads(c, i, pose(model), size);
  }

  /** The same for a file: [what is drawn, its height], `width` wide, with the words of its colours below. */
  sketched(i, width, look) {
    const pen = new Pen(), high = Math.min(width, SKETCH), on = Object.assign(Object.create(Scene.prototype), this, { look, near: { w: width, h: high } });
    on.paint(pen, i);
    const rows = this.colours().flatMap(([words, colour, of]) => broken(`${words}${this.amountOf(of, i)}`, width - 20, look, 11).map((t, k) => [t, k ? null : colour]));
    const named = rows.map(([t, colour], k) => [colour ? svg("rect", { x: 2, y: high + 10 + 15 * k, width: 9, height: 9, fill: look[colour] }) : null, text(18, high + 18 + 15 * k, t, look.ink, "start", { "font-size": 11 })]);
    return [[svg("svg", { width, height: high, viewBox: `0 0 ${width} ${high}`, overflow: "hidden" }, pen.drawn), named], high + 15 * rows.length + 14];
  }

  /** Tiles that stay on the floor, so that one sees it move. */
  floor(c, i) {
    const { near, look, motion: { model } } = this, size = Math.min(near.w, near.h) / CLOSE, tile = 0.5;
    const [right, down] = this.turned(model.x[i], model.y[i]);
    c.strokeStyle = look.line;
    c.lineWidth = 1;
    c.beginPath();
    for (const [at, length, across] of [[right, near.w, true], [down, near.h, false]]) {
      const middle = length / 2, first = Math.ceil((at - length / 2 / size) / tile) * tile;
      for (let v = first; middle + size * (v - at) < length; v += tile) {
        const p = middle + size * (v - at);
        if (across) { c.moveTo(p, 0); c.lineTo(p, near.h); } else { c.moveTo(0, p); c.lineTo(near.w, p); }
      }
    }
    c.stroke();
  }

  chair(c, i, [x, y, psi], size, colour, ghost) {
    const { a, b, t_r: rear, t_f: front, R } = this.geometry, { rolled, results } = this.motion;
    c.save();
    c.translate(x, y); c.rotate(psi); c.scale(size, size);
    c.lineWidth = (ghost ? 1.5 : 2) / size;
    c.strokeStyle = colour;
    if (ghost) c.setLineDash([4 / size, 3 / size]);
    c.beginPath(); c.moveTo(-rear / 2, b); c.lineTo(rear / 2, b); c.lineTo(front / 2, -a); c.lineTo(-front / 2, -a); c.closePath();
    if (!ghost) { c.globalAlpha = 0.14; c.fillStyle = colour; c.fill(); c.globalAlpha = 1; }
    c.stroke();
    c.setLineDash([]);
    for (const [side, way] of [["l", -1], ["r", 1]]) {
      this.wheel(c, (way * rear) / 2, b, 2 * R, 0.045, 0, ghost ? null : rolled[side][i], colour);
      this.wheel(c, (way * front) / 2, -a, 0.14, 0.03, results[`caster.f${side}`]?.[i] ?? 0, null, colour, 0.05);
    }
    if (!ghost) {
      this.rider(c, i, [a, b, rear], colour);
      c.fillStyle = colour; c.beginPath(); c.arc(0, 0, 0.022, 0, 7); c.fill();
    }
    c.restore();
  }

  /** Who sits in it, as wide as the chair lets him: backrest, legs with footrests, shoulders and head, these as far forward as
   *  was recorded. */
  rider(c, i, [a, b, rear], colour) {
    const half = Math.min(0.23, 0.42 * rear), back = b - 0.02, hips = back - 0.1, moved = this.input("rider.s", i) || 0;
    c.fillStyle = c.strokeStyle = colour;
    c.globalAlpha = 0.3;
    for (const side of [-1, 1]) {
      c.beginPath(); c.roundRect(side * 0.42 * half - 0.3 * half, -a - 0.06, 0.6 * half, hips + a + 0.06, 0.05); c.fill();
      c.beginPath(); c.roundRect(side * 0.42 * half - 0.22 * half, -a - 0.26, 0.44 * half, 0.22, 0.04); c.fill();
    }
    c.beginPath(); c.ellipse(0, hips - moved, half, 0.42 * half, 0, 0, 7); c.fill();
    c.globalAlpha = 0.75;
    c.beginPath(); c.arc(0, hips - moved - 0.02, 0.085, 0, 7); c.fill();
    c.lineWidth = 0.03; c.lineCap = "round";
    c.beginPath(); c.moveTo(-half, back); c.lineTo(half, back); c.stroke();
    c.globalAlpha = 1; c.lineCap = "butt";
  }

  /** A wheel from above; treads pass over it as it rolls. */
  wheel(c, x, y, length, width, angle, gone, colour, trail = 0) {
    c.save();
    c.translate(x, y); c.rotate(angle); c.translate(0, trail);
    c.beginPath();
    c.roundRect(-width / 2, -length / 2, width, length, width / 2);
    c.globalAlpha = gone === null ? 0.35 : 0.85; c.fillStyle = colour; c.fill(); c.globalAlpha = 1;
    if (gone !== null) {
      c.strokeStyle = this.look.paper; c.lineWidth = 0.012;
      c.beginPath();
      const pitch = 0.09;
      for (let v = -length / 2 + ((((-gone % pitch) + pitch) % pitch)); v < length / 2; v += pitch) { c.moveTo(-width / 2, v); c.lineTo(width / 2, v); }
      c.stroke();
    }
    c.restore();
  }

  arrows(c, i, [x, y, psi], size) {
    const { motion: { inputs, results, lacking }, look, geometry: { b, t_r: rear } } = this;
    c.save();
    c.translate(x, y); c.rotate(psi);
    for (const [side, way] of [["l", -1], ["r", 1]]) {
      const at = [(way * rear * size) / 2, b * size], push = inputs[`push.F_r${side}`]?.[i] ?? 0, tyre = results[`force.F_sr${side}`]?.[i] ?? 0;
      arrow(c, at[0] + way * 12, at[1], 0, -push * ARROW.push, look.good, 3);
      arrow(c, at[0], at[1], tyre * ARROW.tyre, 0, look.ink, 2);
    }
    const force = lacking.force?.(i), moment = lacking.moment?.(i), swing = this.input("rider.momentum", i);
    if (Number.isFinite(swing)) arrow(c, 0, (b - 0.14 - (this.input("rider.s", i) || 0)) * size, 0, -swing * ARROW.body, look.good, 3);
    if (Number.isFinite(force)) arrow(c, 0, 0, 0, -force * ARROW.missing, look.error, 4);
    if (Number.isFinite(moment) && Math.abs(moment) > 0.02) {
      const sweep = Math.max(-2.4, Math.min(2.4, moment * 2.2)), r = 0.2 * size, from = -Math.PI / 2;
      c.strokeStyle = look.error; c.lineWidth = 4;
      c.beginPath(); c.arc(0, 0, r, from, from + sweep, sweep < 0); c.stroke();
      head(c, r * Math.cos(from + sweep), r * Math.sin(from + sweep), from + sweep + (Math.sign(sweep) * Math.PI) / 2, look.error);
    }
    c.restore();
  }

  /** What each wheel of the model carries, as a number beside it, and what of it is beyond what the model holds for. */
  loads(c, i, [x, y, psi], size) {
    const { a, b, t_r: rear, t_f: front, R } = this.geometry, [sin, cos] = [Math.sin(psi), Math.cos(psi)], { near } = this;
    for (const [side, way] of [["l", -1], ["r", 1]])
      for (const [wheel, px, py, ahead, aside, reach] of [[`r${side}`, (way * rear) / 2, b, -1, 0, R], [`f${side}`, (way * front) / 2, -a, 0, way, 0.13]]) {
        const lines = this.said(wheel, i), wide = Math.max(...lines.map(([words, bold]) => long(words, this.look, LETTERS, bold ? 600 : 400))) / 2, high = (LINE * lines.length) / 2;
        const [u, v] = [cos * aside + sin * ahead, sin * aside - cos * ahead], out = reach * size + 4 + Math.abs(u) * wide + Math.abs(v) * high;
        const at = [x + size * (cos * px - sin * py) + out * u, y + size * (sin * px + cos * py) + out * v].map((p, k) => Math.min(Math.max(p, [wide, high][k] + 2), [near.w, near.h][k] - [wide, high][k] - 2));
        const [left, top] = [at[0] - wide - 1, at[1] - high], box = [2 * wide + 2, 2 * high];
        if (c.drawImage) c.drawImage(pictured(lines, box, this.look, this.scale), Math.round(left * this.scale) / this.scale, Math.round(top * this.scale) / this.scale, ...box.map((v) => Math.ceil(v * this.scale) / this.scale));
        else labelled(c, lines, [left, top], box, this.look);
      }
  }

  /** Lines at a wheel, each [words, whether it is a warning]. */
  said(wheel, i) {
    const load = this.motion.results[`load.${wheel}`][i], lifted = load <= 0;
    return [[`${tick(Math.round(load) || 0)} N`, lifted], lifted && ["lifted", true], this.slips(wheel, i) && ["would spin", true]].filter(Boolean);
  }

  /** Is this rear wheel pushed beyond friction? That one of them is, the model says; the more it is pushed for its load. */
  slips(wheel, i) {
    const { results, friction } = this.motion;
    if (!results["push.beyond_friction"][i] || wheel.startsWith("f")) return false;
    const [own, other] = [wheel, wheel === "rl" ? "rr" : "rl"].map((w) => Math.abs((this.input(`push.F_${w}`, i) || 0) + (this.input(`push.M_${w}`, i) || 0) / this.geometry.R) / Math.max(results[`load.${w}`][i], 1));
    return own >= other || own > friction;
  }

  /** What was recorded of an input at sample `i`; NaN of one that was not. */
  input(name, i) { return this.motion.inputs[name]?.[i] ?? NaN; }

  /** What is what, where that has changed. */
  legend() {
    const rows = this.colours(), shape = rows.join();
    if (shape === this.shape) return;
    this.shape = shape;
    this.key.replaceChildren(...rows.map(([words, colour, of]) => h("li", {}, h("i", { style: `background:var(--${colour})` }), words, this.amounts[of])));
  }

  /** What is what: [words, colour, which amount stands behind it]. */
  colours() {
    const { inputs, lacking, measured } = this.motion;
    return [["model", "model"], measured && [measured.tracked ? "measured: tracked" : "measured: from wheel speeds and yaw rate", "measured"], ["push", "good", "stroke.phase" in inputs && "strokes"], ["side force of a tyre", "ink"], ["load on each wheel", "faint"],
      this.moves().length && [`the rider’s body${"rider.momentum" in inputs ? " (arrow at the head: its momentum)" : ""}: `, "good", "body"],
      (lacking.force || lacking.moment) && ["force that is missing to move as was measured (arrow × 10): ", "error", "missing"]].filter(Boolean);
  }

  says(i) { for (const [of, place] of Object.entries(this.amounts)) write(place, this.amountOf(of, i)); }

  amountOf(of, i) { return of ? { missing: () => this.missed(i), body: () => this.swung(i), strokes: () => this.stroked(i) }[of]() : ""; }

  /** What of the body's motion was recorded. */
  moves() { return Object.keys(BODY).filter((name) => name in this.motion.inputs); }

  /** How many strokes the hands have done by sample `i`. */
  stroked(i) {
    const phase = this.input("stroke.phase", i);
    return Number.isFinite(phase) ? `, ${tick(Number(phase.toFixed(1)))} strokes since the first` : "";
  }

  /** How the body moves at sample `i`. */
  swung(i) { return this.moves().map((name) => BODY[name](this.input(name, i))).join(", "); }

  /** How much is missing at sample `i`. */
  missed(i) {
    const { lacking } = this.motion, said = [], [force, moment] = [lacking.force?.(i), lacking.moment?.(i)];
    if (Number.isFinite(force)) said.push(`${tick(Number(force.toFixed(1)))} N`);
    if (Number.isFinite(moment)) said.push(`${tick(Number(moment.toFixed(2)))} N m`);
    return said.join(", ") || "not known here";
  }
}

/** How each input of the body's is told. */
const BODY = {
  "rider.s": (v) => (Number.isFinite(v) ? `${tick(Number(v.toFixed(3)))} m forward` : "place not known here"),
  "rider.momentum": (v) => (Number.isFinite(v) ? `${tick(Number(v.toFixed(1)))} N s` : "momentum not known here"),
};

const LIMITS = [["load.lifted", "A wheel has left the ground", "the model then no longer holds"], ["push.beyond_friction", "A rear wheel is pushed beyond friction", "it would spin, and in this model it rolls on"]];

/** When the model is beyond what it holds for in a run, in sentences; nothing where it never is. */
function outside({ time, results }) {
  return LIMITS.map(([flag, what, then]) => {
    const raised = results[flag], first = raised.indexOf(1);
    if (first < 0) return "";
    const lasts = raised.reduce((sum, up, i) => sum + (up && i + 1 < time.length ? time[i + 1] - time[i] : 0), 0);
    return `${what} for ${lasts.toFixed(2)} s of this run, first at ${time[first].toFixed(2)} s: ${then}.`;
  }).filter(Boolean).join(" ");
}

const pictures = new Map(); // labels as they are on the canvas, by what they say: to draw letters anew in every frame takes longer

function pictured(lines, size, look, scale) {
  const key = [look.faint, scale, ...lines].join();
  if (!pictures.has(key)) {
    if (pictures.size > MOST) pictures.clear();
    const made = new OffscreenCanvas(...size.map((v) => Math.ceil(v * scale))), c = made.getContext("2d");
    c.scale(scale, scale);
    labelled(c, lines, [0, 0], size, look);
    pictures.set(key, made.transferToImageBitmap());
  }
  return pictures.get(key);
}

/** Lines of words one below the other, on paper, so that they are read there whatever is drawn below. */
function labelled(c, lines, [left, top], [wide, high], look) {
  c.fillStyle = look.paper;
  c.globalAlpha = 0.75;
  c.fillRect(left, top, wide, high);
  c.globalAlpha = 1;
  c.textAlign = "center";
  lines.forEach(([words, bold], k) => {
    c.font = `${bold ? "bold " : ""}${LETTERS}px system-ui, sans-serif`;
    c.fillStyle = bold ? look.warn : look.faint;
    c.fillText(words, left + wide / 2, top + LINE * (k + 0.8));
  });
}

function arrow(c, x, y, dx, dy, colour, width) {
  const length = Math.hypot(dx, dy);
  if (length < 2) return;
  c.strokeStyle = colour; c.lineWidth = width;
  c.beginPath(); c.moveTo(x, y); c.lineTo(x + dx, y + dy); c.stroke();
  head(c, x + dx, y + dy, Math.atan2(dy, dx), colour, Math.min(1, length / 14));
}

function head(c, x, y, angle, colour, size = 1) {
  c.fillStyle = colour;
  c.beginPath();
  for (const turn of [0, 2.5, -2.5]) c[turn ? "lineTo" : "moveTo"](x + (turn ? 10 : 6) * size * Math.cos(angle + turn), y + (turn ? 10 : 6) * size * Math.sin(angle + turn));
  c.fill();
}
