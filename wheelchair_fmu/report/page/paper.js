// What is printed: drawings as wide as their column of an A4 page and no higher than the words about them leave room, so that
// their letters keep their size. A page cannot be measured before it is printed, so words are counted as they will be set.

import { byId, h } from "page/dom";
import { long, look } from "page/draw";

const ACROSS = 703, COLUMN = 400; // px: A4 between its margins, and a drawing in half of it, which is set a little smaller
const PAGES = [998, 1005]; // px: how high the two pages are
const CARDS = [182, 263, 182], ROW = 20; // px: words of each card; a row of a table
const HEAD = 24; // px: a figure's title with what is about it
const LEAST = 220; // px: below which a drawing says nothing

/** How high words are, in lines of this width. */
const set = (words, width, size, weight, high = 1.45) => Math.ceil(long(words, look(), size, weight) / width) * size * high;

/** Height that the verdict takes at the top of the first page. */
function verdict() {
  const card = (c, i) => [...c.children].reduce((sum, e) => sum + (e.matches(".gauge") ? Math.max(40, 7 * e.children.length) : e.matches(".lead") ? set(e.textContent, CARDS[i], 13, 620, 1.3) + 3 : e.matches("h2") ? 15 : set(e.textContent, CARDS[i], 10.5, 400, 1.42) + 2), 12);
  return 16 + set(byId("sentence").textContent, 640, 20, 650, 1.25) + 10 + Math.max(0, ...[...document.querySelectorAll(".card")].map(card)) + 6;
}

/** Height of the evidence table's rows that are printed, and of what is said of ties and of the next run. */
function evidence() {
  const rows = byId("missing").hidden ? [...document.querySelectorAll(".evidence:not(.several) tbody tr")].slice(0, 5) : [], said = [...document.querySelectorAll("#ties > p")];
  const table = rows.reduce((sum, r) => sum + Math.max(1.6, ...[...r.cells].map((c, i) => c.children.length || Math.ceil(long(c.textContent, look(), 9.5) / (i ? 75 : 160)))) * 14 + 6, rows.length ? 56 : 0);
  return table + 34 + said.reduce((sum, p) => sum + set(p.textContent, ACROSS, 10.5) + 8, 0);
}

/** The figures that are printed, drawn anew: [element, ...]. `figures` are those of the page, by name. */
export function papers(figures, runs) {
  const made = [], put = (id, width, room) => {
    const figure = figures[id], drawn = figure?.says.draw(width, look(), Math.max(LEAST, room));
    if (!drawn) return 0;
    const paper = h("div", { class: "paper" }, drawn);
    figure.drawing.after(paper);
    made.push(paper);
    return Number(drawn.getAttribute("height"));
  };
  const table = 2 * HEAD + 40 + Math.min(16, runs) * ROW;
  put("overlay", ACROSS, PAGES[0] - verdict() - table - HEAD - 34);
  const half = Math.max(...["staircase", "physical"].map((id) => put(id, COLUMN))) * (347 / COLUMN);
  const missing = byId("missing").hidden ? 0 : HEAD + 40 + put("missing", ACROSS);
  put("forest", ACROSS, PAGES[1] - 28 - HEAD - half - missing - HEAD - evidence() - 30);
  return made;
}
