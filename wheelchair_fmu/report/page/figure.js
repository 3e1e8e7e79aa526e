// A figure's frame: a heading, one menu that hands out what is drawn, the drawing, and its numbers as a table.

import { csv, h, save } from "page/dom";
import { look } from "page/draw";
import { WIDTHS, publish } from "page/publish";

const HEADS = { "standard error": "±", "given to within (standard deviation)": "given ±", "name in files": null }; // of the table in the page, for readers of it; the CSV has them as they are
const ROWS = 60; // of a table in the page; the CSV has all
let open = null;

document.addEventListener("click", ({ target }) => { if (open && !open.contains(target)) open.open = false; });
document.addEventListener("keydown", ({ key }) => { if (key === "Escape" && open?.open) { open.open = false; open.firstElementChild.focus(); } });

/** Fills a <figure>. `says` is {title, subject(), file(), caption(), columns(), draw(width, look)}; without `own` the drawing
 *  is made by `draw` again with every `redraw()`. */
export class Figure {
  constructor(place, says, own = false) {
    Object.assign(this, { place, says, own });
    const id = `${place.id}-title`;
    this.drawing = h("div", { class: "drawing" });
    this.caption = h("p", { class: "caption", id: `${place.id}-caption` });
    place.setAttribute("aria-labelledby", id);
    place.setAttribute("aria-describedby", this.caption.id);
    this.numbers = h("details", { class: "numbers" }, h("summary", {}, "the numbers"));
    this.numbers.addEventListener("toggle", () => this.tabulate());
    place.replaceChildren(h("figcaption", {}, h("h3", { id }, says.title), this.menu()), this.drawing, this.caption, this.numbers);
  }

  menu() {
    const { says } = this, button = (label, act) => h("button", { type: "button", class: "quiet", onclick: act, "aria-label": `${says.title} as ${label}` }, label);
    const kinds = ["svg", "png", "pdf"].map((kind) => h("div", {}, Object.keys(WIDTHS).map((mm) => button(`${kind.toUpperCase()} ${mm} mm`, () => publish(says, kind, Number(mm))))));
    const made = h("details", { class: "menu" }, h("summary", { "aria-label": `Save ${says.title}` }, "save"),
      h("div", { class: "choices" }, kinds, h("div", {}, button("CSV", () => save(`${says.file()}.csv`, csv(says.columns()))))));
    made.addEventListener("toggle", () => { if (made.open) open = made; });
    return made;
  }

  redraw() {
    if (!this.own) this.drawing.replaceChildren(this.says.draw(Math.max(280, this.drawing.clientWidth || 640), look()));
    this.said();
  }

  /** What the caption and the table say, without drawing anew. */
  said() {
    this.caption.textContent = this.says.caption();
    if (this.numbers.open) this.tabulate();
  }

  tabulate() {
    if (!this.numbers.open) return;
    const columns = this.says.columns(), names = Object.keys(columns).filter((n) => HEADS[n] !== null), length = Math.max(...names.map((n) => columns[n].length));
    const every = Math.max(1, Math.ceil(length / ROWS)), shown = Array.from({ length: Math.ceil(length / every) }, (_, i) => i * every);
    this.numbers.replaceChildren(this.numbers.firstElementChild, h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": `Numbers of ${this.says.title}` },
      h("table", {}, h("caption", {}, every > 1 ? `One row in ${every}; the CSV has all` : this.says.title),
        h("thead", {}, h("tr", {}, names.map((n) => h("th", { scope: "col" }, HEADS[n] ?? n)))),
        h("tbody", {}, shown.map((i) => h("tr", {}, names.map((n) => h("td", {}, printed(columns[n][i])))))))));
  }
}

const printed = (v) => (typeof v === "number" ? (Number.isFinite(v) ? String(Number(v.toPrecision(4))).replace("-", "−") : "–") : v ?? "–");
