// The chair from above on a canvas: the whole path, and close by the model's chair with the measured one as a ghost, its wheels
// and casters turning, and arrows of what pushes it.

import { h, sized } from "page/dom";
import { extent, round, tick } from "page/draw";

const ARROW = { push: 1.1, tyre: 1.1, missing: 11 }; // px per N; what is missing is small
const CLOSE = 1.5; // m across the close view
const LEGEND = 84; // px
const FONT = "11.5px system-ui, sans-serif";

export class Scene {
  constructor(place, campaign) {
    this.geometry = campaign.geometry;
    this.canvas = h("canvas", { class: "scene", role: "img" });
    this.paths = h("canvas", { "aria-hidden": "true" }); // behind it the overview, which only changes with the run and the model
    place.append(h("div", { class: "scenery" }, this.paths, this.canvas));
    this.room = sized(place);
  }

  /** `motion` is {time, model, measured, before, results, inputs, rolled, lacking}; see app.js. */
  show(motion, look, name) {
    Object.assign(this, { motion, look });
    const { model } = motion;
    this.canvas.setAttribute("aria-label", `The chair from above in ${name}: it goes ${round(model.x.at(-1))} m forward and ${round(model.y.at(-1))} m to the right in ${round(motion.time.at(-1) - motion.time[0])} s`);
    this.fit();
    this.trace();
  }

  fit() {
    const width = Math.max(260, this.room()[0]), height = Math.round(Math.min(620, Math.max(400, width * 1.45))), scale = devicePixelRatio || 1;
    const { model, measured, before } = this.motion, every = [model, measured, before].filter(Boolean);
    const [xs, ys] = ["x", "y"].map((c) => extent(...every.map((p) => p[c])));
    this.lying = xs[1] - xs[0] > ys[1] - ys[0];
    if (this.width !== width || this.height !== height || this.scale !== scale) {
      Object.assign(this, { width, height, scale });
      for (const c of [this.canvas, this.paths]) [c.width, c.height] = [width * scale, height * scale];
      this.canvas.parentNode.style.height = `${height}px`;
    }
    const inner = height - LEGEND, part = 0.36;
    this.over = this.lying ? { x: 0, y: 0, w: width, h: Math.round(inner * part) } : { x: 0, y: 0, w: Math.round(width * part), h: inner };
    this.near = this.lying ? { x: 0, y: this.over.h, w: width, h: inner - this.over.h } : { x: this.over.w, y: 0, w: width - this.over.w, h: inner };
    const [[left, right], [top, bottom]] = this.lying ? [xs, ys] : [ys, [-xs[1], -xs[0]]], room = 0.5, edge = 26;
    const zoom = Math.min((this.over.w - 2 * edge) / (right - left + 2 * room), (this.over.h - 2 * edge) / (bottom - top + 2 * room));
    this.zoom = zoom;
    this.middle = [(left + right) / 2, (top + bottom) / 2];
  }

  /** Right and down on paper of metres forward and to the right. */
  turned(x, y) {
    return this.lying ? [x, y] : [y, -x];
  }

  overview(x, y) {
    const [right, down] = this.turned(x, y), { over } = this;
    return [over.x + over.w / 2 + this.zoom * (right - this.middle[0]), over.y + over.h / 2 + this.zoom * (down - this.middle[1])];
  }

  trace() {
    const c = this.paths.getContext("2d"), { look, over, motion } = this;
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    c.clearRect(0, 0, this.width, this.height);
    c.strokeStyle = look.line;
    c.fillStyle = look.faint;
    c.font = "11px system-ui, sans-serif";
    const metres = [1, 2, 5, 10, 20, 50].find((m) => m * this.zoom > 30) ?? 100, at = [over.x + 10, over.y + over.h - 10];
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
    this.legend(c);
  }

  /** All of it at sample `i`. */
  draw(i) {
    const c = this.canvas.getContext("2d"), { motion, look, near } = this, { model, measured } = motion;
    if (!(near.w > 0)) return;
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    for (const [p, colour] of [[measured, look.measured], [model, look.model]]) {
      if (!p || !Number.isFinite(p.x[i] + p.y[i])) continue;
      c.fillStyle = colour;
      c.beginPath(); c.arc(...this.overview(p.x[i], p.y[i]), 4.5, 0, 7); c.fill();
    }
    c.save();
    c.beginPath(); c.rect(near.x, near.y, near.w, near.h); c.clip();
    this.floor(c, i);
    const size = Math.min(near.w, near.h) / CLOSE, pose = (p) => {
      const [right, down] = this.turned(p.x[i] - model.x[i], p.y[i] - model.y[i]);
      return [near.x + near.w / 2 + size * right, near.y + near.h / 2 + size * down, p.psi[i] + (this.lying ? Math.PI / 2 : 0)];
    };
    if (measured && Number.isFinite(measured.x[i] + measured.psi[i])) this.chair(c, i, pose(measured), size, look.measured, true);
    this.chair(c, i, pose(model), size, look.model, false);
    this.arrows(c, i, pose(model), size);
    c.restore();
    this.amount(c, i);
  }

  /** Tiles that stay on the floor, so that one sees it move. */
  floor(c, i) {
    const { near, look, motion: { model } } = this, size = Math.min(near.w, near.h) / CLOSE, tile = 0.5;
    const [right, down] = this.turned(model.x[i], model.y[i]);
    c.strokeStyle = look.line;
    c.lineWidth = 1;
    c.beginPath();
    for (const [at, from, length, across] of [[right, near.x, near.w, true], [down, near.y, near.h, false]]) {
      const middle = from + length / 2, first = Math.ceil((at - length / 2 / size) / tile) * tile;
      for (let v = first; middle + size * (v - at) < from + length; v += tile) {
        const p = middle + size * (v - at);
        if (across) { c.moveTo(p, near.y); c.lineTo(p, near.y + near.h); } else { c.moveTo(near.x, p); c.lineTo(near.x + near.w, p); }
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
      this.rider(c, a, b, rear, colour);
      c.fillStyle = colour; c.beginPath(); c.arc(0, 0, 0.022, 0, 7); c.fill();
    }
    c.restore();
  }

  /** Who sits in it, as wide as the chair lets him: backrest, legs with footrests, shoulders and head. */
  rider(c, a, b, rear, colour) {
    const half = Math.min(0.23, 0.42 * rear), back = b - 0.02, hips = back - 0.1;
    c.fillStyle = c.strokeStyle = colour;
    c.globalAlpha = 0.3;
    for (const side of [-1, 1]) {
      c.beginPath(); c.roundRect(side * 0.42 * half - 0.3 * half, -a - 0.06, 0.6 * half, hips + a + 0.06, 0.05); c.fill();
      c.beginPath(); c.roundRect(side * 0.42 * half - 0.22 * half, -a - 0.26, 0.44 * half, 0.22, 0.04); c.fill();
    }
    c.beginPath(); c.ellipse(0, hips, half, 0.42 * half, 0, 0, 7); c.fill();
    c.globalAlpha = 0.75;
    c.beginPath(); c.arc(0, hips - 0.02, 0.085, 0, 7); c.fill();
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
    const force = lacking.force?.[i], moment = lacking.moment?.[i];
    if (Number.isFinite(force)) arrow(c, 0, 0, 0, -force * ARROW.missing, look.error, 4);
    if (Number.isFinite(moment) && Math.abs(moment) > 0.02) {
      const sweep = Math.max(-2.4, Math.min(2.4, moment * 2.2)), r = 0.2 * size, from = -Math.PI / 2;
      c.strokeStyle = look.error; c.lineWidth = 4;
      c.beginPath(); c.arc(0, 0, r, from, from + sweep, sweep < 0); c.stroke();
      head(c, r * Math.cos(from + sweep), r * Math.sin(from + sweep), from + sweep + (Math.sign(sweep) * Math.PI) / 2, look.error);
    }
    c.restore();
  }

  /** What is what; how much is missing stands behind its words. */
  legend(c) {
    const { look, motion: { lacking, measured } } = this, lacks = lacking.force || lacking.moment;
    c.font = FONT;
    const rows = [["model", look.model], measured && [measured.tracked ? "measured: tracked" : "measured: from wheel speeds and yaw rate", look.measured], ["push", look.good], ["side force of a tyre", look.ink],
      lacks && ["missing (arrow × 10): ", look.error]].filter(Boolean);
    rows.forEach(([words, colour], k) => {
      const y = this.height - LEGEND + 18 + 15 * k;
      c.fillStyle = colour; c.fillRect(2, y - 8, 9, 9);
      c.fillStyle = look.ink; c.fillText(words, 16, y);
      this.behind = [16 + c.measureText(words).width, y];
    });
  }

  /** How much is missing at sample `i`. */
  amount(c, i) {
    const { look, motion: { lacking } } = this, said = [];
    const [force, moment] = [lacking.force?.[i], lacking.moment?.[i]];
    if (Number.isFinite(force)) said.push(`${tick(Number(force.toFixed(1)))} N`);
    if (Number.isFinite(moment)) said.push(`${tick(Number(moment.toFixed(2)))} N m`);
    if (!lacking.force && !lacking.moment) return;
    c.font = FONT;
    c.fillStyle = look.ink;
    c.fillText(said.join(", ") || "–", ...this.behind);
  }
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
