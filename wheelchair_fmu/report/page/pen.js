// What draws on a canvas, as far as the scene needs it, on paper instead: the same calls make SVG, for files of lines and letters.

import { svg, text } from "page/draw";

const STATE = { fillStyle: "none", strokeStyle: "none", lineWidth: 1, lineCap: "butt", globalAlpha: 1, font: "12px", textAlign: "start", dash: [], turns: "" };

export class Pen {
  constructor() {
    Object.assign(this, STATE, { drawn: [], kept: [], d: "" });
  }

  save() { this.kept.push(Object.fromEntries(Object.keys(STATE).map((k) => [k, this[k]]))); }
  restore() { Object.assign(this, this.kept.pop()); }
  translate(x, y) { this.turns += `translate(${x} ${y})`; }
  rotate(angle) { this.turns += `rotate(${(angle * 180) / Math.PI})`; }
  scale(x, y) { this.turns += `scale(${x} ${y})`; }
  setLineDash(dash) { this.dash = dash; }

  beginPath() { this.d = ""; }
  closePath() { this.d += "Z"; }
  moveTo(x, y) { this.d += `M${x} ${y}`; }
  lineTo(x, y) { this.d += `${this.d ? "L" : "M"}${x} ${y}`; }
  arc(x, y, r, from, to, back = false) { this.ellipse(x, y, r, r, 0, from, to, back); }

  /** Upright only; from 0 to 7 radians is the whole of it. */
  ellipse(x, y, a, b, _, from, to, back = false) {
    if (Math.abs(to - from) >= 2 * Math.PI) this.d += `M${x - a} ${y}A${a} ${b} 0 1 1 ${x + a} ${y}A${a} ${b} 0 1 1 ${x - a} ${y}Z`;
    else this.d += `M${x + a * Math.cos(from)} ${y + b * Math.sin(from)}A${a} ${b} 0 ${Math.abs(to - from) > Math.PI ? 1 : 0} ${back ? 0 : 1} ${x + a * Math.cos(to)} ${y + b * Math.sin(to)}`;
  }

  roundRect(x, y, w, h, r) {
    const corner = (u, v) => `A${r} ${r} 0 0 1 ${u} ${v}`;
    this.d += `M${x + r} ${y}H${x + w - r}${corner(x + w, y + r)}V${y + h - r}${corner(x + w - r, y + h)}H${x + r}${corner(x, y + h - r)}V${y + r}${corner(x + r, y)}Z`;
  }

  fill() { this.put({ fill: this.fillStyle, "fill-opacity": this.globalAlpha }); }
  stroke() { this.put({ fill: "none", stroke: this.strokeStyle, "stroke-width": this.lineWidth, "stroke-opacity": this.globalAlpha, "stroke-linecap": this.lineCap, "stroke-dasharray": this.dash.length ? this.dash.join(" ") : null }); }
  fillRect(x, y, w, h) { this.d = `M${x} ${y}H${x + w}V${y + h}H${x}Z`; this.fill(); }
  fillText(words, x, y) {
    const anchor = { center: "middle", right: "end" }[this.textAlign] ?? "start";
    this.drawn.push(text(x, y, words, this.fillStyle, anchor, { "font-size": parseFloat(this.font.match(/[\d.]+px/)), "font-weight": this.font.startsWith("bold") ? 600 : null }));
  }
  put(how) { this.drawn.push(svg("path", { d: this.d, transform: this.turns || null, ...how })); }
}
