// Tables of errors whose cells stay quiet where a model's error is the noise, and turn the colour of an error where it is not.

import { h } from "page/dom";
import { broken, canvas, long, svg, text, whole } from "page/draw";
import { rms, significant } from "page/numbers";

export const QUIET = 1.1; // whitened RMS without colour
const LOUD = 6; // and with all of it
const NOTE = 10; // size of a cell's second line: six points where a figure is 85 mm wide
const UPRIGHT = 84; // px: how high heads stand where they are too many to lie
const STRONGEST = 55; // per cent of colour, on which text in ink still stands out

/** How much colour an error has, in per cent. */
export const loud = (v) => (Number.isFinite(v) ? Math.round(Math.min(1, Math.max(0, Math.log(v / QUIET) / Math.log(LOUD / QUIET))) * STRONGEST) : 0);

const number = (v) => (Number.isFinite(v) ? (v < 10 ? rms(v) : significant(v, 3)) : "–"); // three digits at most have room in a column

/** A table in the page. `rows` are [{name, note, cells: [{value, note, label, at}]}]; `choose(at)` makes cells buttons. */
export class Heat {
  constructor(place, caption, heads, choose) {
    Object.assign(this, { choose });
    this.body = h("tbody");
    place.replaceChildren(h("div", { class: "wide plainly", tabindex: 0, role: "region", "aria-label": caption },
      h("table", { class: "heat" }, h("caption", { class: "unseen" }, caption), h("thead", {}, h("tr", {}, h("td"), heads.map((t) => h("th", { scope: "col" }, t)))), this.body)));
    this.cells = [];
    this.body.addEventListener("keydown", (event) => this.moved(event));
    new IntersectionObserver(([entry]) => { this.seen = entry.isIntersecting; }).observe(place);
  }

  show(rows, chosen = null) {
    const shape = rows.map((r) => `${r.name} ${r.cells.length}`).join("|");
    if (shape !== this.shape) this.build(rows, shape);
    rows.forEach((row, i) => row.cells.forEach((cell, j) => {
      const made = this.cells[i][j], value = number(cell.value), strong = `${loud(cell.value)}%`;
      if (made.value !== value) made.figure.textContent = made.value = value;
      if (made.note && made.note.textContent !== cell.note) made.note.textContent = cell.note;
      if (made.strong !== strong) made.cell.style.setProperty("--loud", (made.strong = strong));
      if (chosen) made.cell.toggleAttribute("data-chosen", chosen(cell.at));
      if (chosen?.(cell.at)) this.reach(i, j);
    }));
  }

  /** Of all cells one is reached by the tab key; from there arrow keys go on. */
  reach(i, j) {
    const [was, now] = [this.reached, this.cells[i][j].figure];
    if (was === now) return;
    if (was) was.tabIndex = -1;
    now.tabIndex = 0;
    this.reached = now;
  }

  moved(event) {
    const way = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key], i = this.cells.findIndex((row) => row.some((c) => c.figure === event.target));
    if (!way || i < 0) return;
    const [row, column] = [i + way[0], this.cells[i].findIndex((c) => c.figure === event.target) + way[1]];
    event.preventDefault();
    if (!this.cells[row]?.[column]) return;
    this.reach(row, column);
    this.reached.focus();
  }

  build(rows, shape) {
    this.shape = shape;
    this.reached = null;
    this.cells = rows.map((row) => row.cells.map((cell) => {
      const figure = h(this.choose ? "button" : "span", this.choose ? { type: "button", class: "plain", tabindex: -1, "aria-label": cell.label, onclick: () => this.choose(cell.at) } : {});
      const note = cell.note === undefined ? null : h("small");
      return { figure, note, cell: h("td", {}, figure, note) };
    }));
    this.body.replaceChildren(...rows.map((row, i) => h("tr", {}, h("th", { scope: "row" }, row.name, row.note ? h("small", {}, row.note) : null), this.cells[i].map((c) => c.cell))));
    if (this.choose && this.cells[0]?.length) this.reach(0, 0);
  }
}

/** The same as a drawing; `shown` is what a cell says in place of its value, by which it is coloured. */
export function heat(width, look, heads, rows) {
  const called = (r) => (r.note ? `${r.name} (${r.note})` : r.name), words = heads.flatMap((t) => t.split(/\s+/)), longest = Math.max(0, ...words.map((w) => long(w, look, 10))) + 4;
  const named = 14 + Math.max(...rows.map((r) => long(called(r), look))), upright = width - longest * heads.length < Math.min(0.24 * width, named); // where heads beside one another would leave no room for names
  const left = upright ? Math.min(0.38 * width, named) : Math.max(0.18 * width, Math.min(0.3 * width, named, width - longest * heads.length)), wide = (width - left) / heads.length, drawn = [];
  const size = upright ? 10 : whole(heads, wide - 4, look, [11, 10]), lines = heads.map((t) => broken(t, upright ? UPRIGHT : wide - 4, look, size, 400, upright ? 2 : 7));
  const top = 8 + (upright ? Math.max(...lines.flat().map((t) => long(t, look, size))) : 13 * Math.max(1, ...lines.map((n) => n.length)));
  lines.forEach((own, j) => own.forEach((t, k) => {
    const middle = left + wide * (j + 0.5);
    drawn.push(upright ? text(0, 0, t, look.ink, "start", { transform: `translate(${middle + 4 + 12 * (k - (own.length - 1) / 2)} ${top - 4}) rotate(-90)`, "font-size": size })
      : text(middle, 12 + 13 * k, t, look.ink, "middle", { "font-size": size }));
  }));
  let y = top;
  for (const row of rows) {
    const name = broken(called(row), left - 12, look, 12, 400, 3), notes = row.cells.map((c) => (c.note ? broken(c.note, wide - 6, look, NOTE, 400, 2) : [])), noted = Math.max(...notes.map((n) => n.length));
    const high = Math.max([24, 32, 45][name.length - 1], 24 + 11 * noted - (noted ? 1 : 0));
    name.forEach((t, k) => drawn.push(text(left - 8, y + high / 2 + 4 + 13 * (k - (name.length - 1) / 2), t, look.ink, "end")));
    row.cells.forEach((c, j) => {
      const x = left + wide * j, middle = x + wide / 2;
      drawn.push(svg("rect", { x: x + 1, y: y + 1, width: wide - 2, height: high - 2, fill: look.error, "fill-opacity": loud(c.value) / 100, stroke: look.line }),
        text(middle, y + (noted ? 15 : high / 2 + 4), c.shown ?? number(c.value), look.ink, "middle"), notes[j].map((t, k) => text(middle, y + 27 + 11 * k, t, look.ink, "middle", { "font-size": NOTE })));
    });
    y += high;
  }
  return canvas(width, y + 4, drawn);
}
