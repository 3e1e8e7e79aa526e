// What every figure is drawn with: SVG elements, colours of the theme or of paper, and axes.

import { indexed } from "page/dom";

const NS = "http://www.w3.org/2000/svg", XML = "http://www.w3.org/XML/1998/namespace";
const NAMES = ["ink", "faint", "line", "paper", "measured", "model", "before", "error", "band", "accent", "good", "warn", "pin-a", "pin-b", "pin-c"];

/** Colours on paper, whatever the theme; measured, model, before and error mean the same in every figure. */
export const PRINT = {
  ink: "#111111", faint: "#505050", line: "#d9d9d9", paper: "#ffffff", measured: "#767676", model: "#0072b2", before: "#9a6fb0",
  error: "#d55e00", band: "#dcebf5", accent: "#0067a8", good: "#00684a", warn: "#9a4a00", "pin-a": "#7a4b1e", "pin-b": "#66700a",
  "pin-c": "#b3134f", print: true,
};

const WRITTEN = "system-ui, 'Helvetica Neue', Arial, sans-serif";
export const FONT = "DejaVu Sans"; // which files carry
export const PRINTED = `'${FONT}', Helvetica, Arial, sans-serif`;

/** The colours of the page as it is now. */
export function look() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(NAMES.map((n) => [n, style.getPropertyValue(`--${n}`).trim()]));
}

export function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) if (value !== null && value !== undefined) name.startsWith("xml:") ? made.setAttributeNS(XML, name, value) : made.setAttribute(name, value);
  made.append(...children.flat(Infinity).filter((c) => c !== null && c !== undefined && c !== false));
  return made;
}

/** An SVG element of this size, hidden from screen readers: a table says the same. */
export const canvas = (width, height, children) =>
  svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, "aria-hidden": "true", "font-family": WRITTEN, "font-size": 12 }, children);

/** Text at a place; `anchor` is start, middle or end. */
export const text = (x, y, words, fill, anchor = "start", more = {}) => svg("text", { x: round(x), y: round(y), fill, "text-anchor": anchor, ...more }, String(words));

/** The same, symbols with their index below the line. */
export function symbolic(x, y, words, fill, anchor, more) {
  const made = text(x, y, "", fill, anchor, { ...more, "xml:space": "preserve" }); // else some programs drop the space after an index
  let low = false;
  made.replaceChildren(...indexed(String(words)).map(([t, below]) => {
    const piece = svg("tspan", { dy: below === low ? null : below ? 3 : -3, "font-size": below ? "10" : null }, t);
    low = below;
    return piece;
  }));
  return made;
}

export const line = (x1, y1, x2, y2, stroke, more = {}) => svg("path", { d: `M${round(x1)} ${round(y1)}L${round(x2)} ${round(y2)}`, stroke, fill: "none", ...more });

/** A path through points; a gap where one is not finite. */
export function course(xs, ys, stroke, more = {}) {
  let d = "", pen = "M";
  for (let i = 0; i < xs.length; i++) {
    if (!Number.isFinite(xs[i]) || !Number.isFinite(ys[i])) { pen = "M"; continue; }
    d += `${pen}${round(xs[i])} ${round(ys[i])}`;
    pen = "L";
  }
  return svg("path", { d, stroke, fill: "none", "stroke-linejoin": "round", ...more });
}

const LAPSE = 5; // usual steps of a series: what is further apart is a gap in it

/** Where a series has values: their places, and the longest time between two of them that is no gap. Rows of several devices lie
 *  between one another's samples, so that most of a series may be NaN without a gap in it. */
export function present(time, values) {
  const at = [];
  for (let i = 0; i < values.length; i++) if (Number.isFinite(values[i])) at.push(i);
  const steps = Float64Array.from(at.slice(1), (i, k) => time[i] - time[at[k]]).sort();
  return { at, lapse: LAPSE * (steps[steps.length >> 1] ?? Infinity) };
}

export const round = (v) => Math.round(v * 10) / 10;

const FEWEST = 3; // ticks, as fewer are no scale; where there is room for so many

/** Round numbers from low to high, about so many. */
export function ticks(low, high, about = 5) {
  const raw = (high - low) / Math.max(1, about), size = 10 ** Math.floor(Math.log10(raw)), steps = [10, 5, 2, 1, 0.5, 0.2].map((k) => k * size);
  let out = [];
  for (const step of steps.slice(Math.max(0, steps.findLastIndex((s) => s >= raw)))) {
    out = [];
    for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-9 * step ? 0 : v);
    if (out.length >= Math.min(FEWEST, about)) break;
  }
  return out;
}

/** A tick's number, without the rounding errors of adding steps. */
export const tick = (v) => String(Number(v.toPrecision(6))).replace("-", "−");

/** Ticks [[value, words]] with as many decimals as any of them needs. */
export function ticked(values) {
  const places = Math.max(0, ...values.map((v) => (String(Number(v.toPrecision(6))).split(".")[1] ?? "").length));
  return values.map((v) => [v, v === 0 ? "0" : v.toFixed(Math.min(places, 8)).replace("-", "−")]);
}

/** Least and greatest of what is finite; [0, 1] of nothing. */
export function extent(...series) {
  let low = Infinity, high = -Infinity;
  for (const values of series) for (const v of values) if (Number.isFinite(v)) { if (v < low) low = v; if (v > high) high = v; }
  return low <= high ? [low, high] : [0, 1];
}

let pen = null;

/** How wide words are, in units of drawing, as they are written on the page or, where `look` is of print, in files. */
export function long(words, look, size = 12, weight = 400) {
  pen ??= document.createElement("canvas").getContext("2d");
  pen.font = `${weight >= 600 ? "bold" : "normal"} ${size}px ${look.print ? PRINTED : WRITTEN}`;
  return pen.measureText(words).width;
}

/** Words in lines no wider than this, at most `most` of them, the end given by dots; only a word that has no place on a line
 *  of its own is broken. */
export function broken(words, width, look, size = 12, weight = 400, most = Infinity) {
  const fits = (t) => long(t, look, size, weight) <= width, lines = [];
  for (const word of words.split(/\s+/).flatMap((w) => pieces(w, fits))) {
    if (lines.length && fits(`${lines.at(-1)} ${word.text}`) && !word.on) lines[lines.length - 1] += ` ${word.text}`;
    else lines.push(word.text);
  }
  if (lines.length <= most) return lines;
  return [...lines.slice(0, most - 1), cut(lines.slice(most - 1).join(" "), fits)];
}

/** The first of these sizes at which no word is broken on lines of this width, or the last. */
export const whole = (names, width, look, sizes) => sizes.find((size) => names.flatMap((t) => t.split(/\s+/)).every((w) => long(w, look, size) <= width)) ?? sizes.at(-1);

/** A word as [{text, on}], parted at its own hyphens where it is too wide, and with more of them where that does not do; `on` says
 *  that it goes on from the piece before. */
function pieces(word, fits) {
  if (fits(word)) return [{ text: word, on: false }];
  const out = [];
  let line = "";
  const put = (t) => { if (t) out.push({ text: t, on: out.length > 0 }); };
  for (const part of word.split(/(?<=-)(?=[^-])/)) {
    if (fits(line + part)) { line += part; continue; }
    put(line);
    line = "";
    for (const letter of part) {
      if (line.length > 1 && !fits(`${line}${letter}-`)) { put(`${line}-`); line = ""; }
      line += letter;
    }
  }
  put(line);
  return out;
}

const cut = (words, fits) => {
  const letters = [...words];
  while (letters.length > 1 && !fits(`${letters.join("").trimEnd()}…`)) letters.pop();
  return `${letters.join("").trimEnd()}…`;
};

/** Words on one line no wider than this, the end given by dots. */
export const fitted = (words, width, look, size = 12, weight = 400) => broken(words, width, look, size, weight, 1)[0];
