// Elements, without a framework: text is always text, never markup.

/** Is the page one column, as on a phone? */
export const NARROW = matchMedia("(max-width: 860px)");

/** h("td", {class: "number"}, "1.0") */
export function h(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return made;
}

/** Words whose symbols have their index below the line, C_λ, and whose sizes stay on one: 1.22 ± 0.19 N. */
export const symbols = (words) => indexed(words.replace(/(\d) (?=(?:N|m|kg|rad|s|°)(?![\p{L}\d]))/gu, "$1\u00a0").replace(/ ± ([\d.]+)( (?=\S))?/g, (_, error, unit) => `\u00a0±\u00a0${error}${unit ? "\u00a0" : ""}`)).map(([t, below]) => (below ? h("sub", {}, t) : t));

/** Words in pieces [[text, whether it is an index]]. */
export function indexed(words) {
  const out = [];
  let from = 0;
  for (const { 0: whole, 1: letter, 2: index, index: at } of words.matchAll(/(?<![\p{L}\d_])(\p{L})_([\p{L}\d]+)(?![\p{L}\d_])/gu)) {
    out.push([words.slice(from, at) + letter, false], [index, true]);
    from = at + whole.length;
  }
  return [...out, [words.slice(from), false]].filter(([t]) => t);
}

/** How wide and high an element is inside, asked for seldom: () => [width, height]. To ask the element itself would have the page
 *  laid out anew with every drawing. */
export function sized(element) {
  let size = null;
  new ResizeObserver(() => { size = null; }).observe(element);
  return () => (size ??= [element.clientWidth, element.clientHeight]);
}

/** Says something else, where that is something else: to say the same again would have the page laid out anew. */
export function write(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

export const byId = (id) => document.getElementById(id);

/** What is packed in base64 of deflated JSON; series come as {f64: [...]}, null in gaps. */
export async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return decoded(JSON.parse(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text()));
}

function decoded(value) {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map(decoded);
  if (Array.isArray(value.f64)) return Float64Array.from(value.f64, (v) => v ?? NaN);
  return Object.fromEntries(Object.entries(value).map(([k, v]) => [k, decoded(v)]));
}

/** Offer text, bytes of a kind of their own or an address as a file. */
export function save(name, content, type = "text/csv;charset=utf-8") {
  const held = content instanceof Blob ? content : content.startsWith("data:") ? null : new Blob([content], { type }), url = held ? URL.createObjectURL(held) : content;
  h("a", { href: url, download: name }).click();
  if (url.startsWith("blob:")) setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Columns {header: array} as CSV. */
export function csv(columns) {
  const names = Object.keys(columns), lines = [names.map(cell).join(",")];
  const length = Math.max(...names.map((n) => columns[n].length));
  for (let i = 0; i < length; i++) lines.push(names.map((n) => cell(columns[n][i])).join(","));
  return lines.join("\n") + "\n";
}

function cell(value) {
  if (value === undefined || value === null || Number.isNaN(value)) return "";
  const text = String(value);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
