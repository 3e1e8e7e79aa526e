// Estimates with their 95 % intervals: of effects, in sizes of interest; of calibrated values, in standard deviations of what
// was given.

import { broken, canvas, line, long, svg, symbolic, text, ticked, ticks } from "page/draw";
import { UNSEEN } from "page/numbers";
import { capital } from "page/words";

const ROW = 24, CLIP = 12;

/** Where names, rows and numbers of a forest plot have their places: beside one another, or, where it is narrow, above. */
function places(width, look, rows) {
  const narrow = width < 560, weight = (r) => (r.strong ? 600 : 400), noted = Math.max(...rows.flatMap((r) => [long(r.note, look, 11.5), long(r.under ?? "", look, 11)]));
  const left = narrow ? 12 : Math.min(0.48 * width, 14 + Math.max(...rows.map((r) => long(r.name, look, 12, weight(r))))), right = narrow ? 12 : noted + 20;
  let y = 24;
  const all = rows.map((r) => {
    const name = broken(r.name, narrow ? width - 2 * left - Math.max(long(r.note, look, 11), long(r.under ?? "", look, 11)) - 10 : left - 12, look, 12, weight(r), narrow ? 3 : 2), lines = Math.max(name.length, r.under ? 2 : 1), high = (narrow ? 2 * ROW + 14 * (lines - 1) : ROW + 10 * (lines > 1)), top = y;
    y += high;
    return { name, top, high, middle: narrow ? top + high - 14 : top + high / 2 };
  });
  return { narrow, left, right, all, end: y + 6 };
}

/** How many rows a plot of this height has. */
export const fitting = (high) => Math.floor((high - 70) / (ROW + 3));

/** `rows` are [{name, value, low, high, note, strong}], in units of `unit`, some with a second note `under` the first and `bounds`
 *  that a value could not leave; the band from −`band` to `band` is what the words `shaded` say. */
export function forest(width, look, rows, unit, shaded, band = 1) {
  const { narrow, left, right, all, end } = places(width, look, rows);
  const strong = rows.filter((r) => r.strong && r.note !== UNSEEN).flatMap((r) => [r.low, r.high, ...(r.bounds ?? [])]), ends = rows.flatMap((r) => [r.low, r.high]).filter((v) => Math.abs(v) < CLIP);
  const [low, most] = [Math.min(-1.5 * band, ...strong, ...ends), Math.max(1.5 * band, ...strong, ...ends)].map((v) => v * 1.06);
  const across = (v) => left + ((width - left - right) * (v - low)) / (most - low), drawn = [];
  const strips = narrow ? all.map(({ middle }) => [middle - 9, middle + 9]) : [[24, end]], marks = ticked(ticks(low, most, Math.max(4, (width - left - right) / 70))); // no line runs through words
  for (const [from, to] of strips) {
    drawn.push(svg("rect", { x: across(-band), y: from, width: across(band) - across(-band), height: to - from, fill: look.band }));
    for (const [v] of marks) drawn.push(line(across(v), from, across(v), to, v === 0 ? look.faint : look.line));
  }
  for (const [v, words] of marks) drawn.push(text(across(v), end + 15, words, look.faint, "middle", { "font-size": 11 }));
  const half = long(shaded, look, 11) / 2 + 2;
  drawn.push(text(Math.max(half, Math.min(width - half, across(0))), 14, shaded, look.faint, "middle", { "font-size": 11 }));
  rows.forEach((r, i) => drawn.push(written(r, all[i], narrow, left, width - right, look), ...drawnRow(r, all[i].middle, across, [low, most], look)));
  const middle = (left + width - right) / 2, title = broken(unit, 2 * Math.min(middle, width - middle) - 16, look);
  title.forEach((t, i) => drawn.push(text(middle, end + 32 + 14 * i, t, look.ink, "middle")));
  return canvas(width, end + 26 + 14 * title.length, drawn);
}

/** A row's name and number. */
function written(r, { name, top, middle }, narrow, left, right, look) {
  const weight = { "font-weight": r.strong ? 600 : 400 };
  const [at, side, step, first] = narrow ? [right, "end", 13, top + 17] : [right + 10, "start", 13, middle + (r.under ? -2 : 4)];
  const notes = [text(at, first, r.note, r.strong && !narrow ? look.ink : look.faint, side, { "font-size": narrow ? 11 : 11.5 }), r.under ? text(at, first + step, r.under, look.faint, side, { "font-size": 11 }) : null];
  if (narrow) return [name.map((t, k) => symbolic(left, top + 17 + 14 * k, t, look.ink, "start", weight)), notes];
  return [name.map((t, k) => symbolic(left - 10, middle + 4 + 13 * (k - (name.length - 1) / 2), t, look.ink, "end", weight)), notes];
}

/** A row's bounds, interval and value. */
function drawnRow(r, y, across, [low, most], look) {
  const colour = r.strong ? look.accent : look.faint, [a, b] = [Math.max(r.low, low), Math.min(r.high, most)], out = [];
  for (const at of r.bounds ?? []) if (at >= low && at <= most) out.push(line(across(at), y - 10, across(at), y + 10, look.error, { "stroke-width": 2.5 }));
  if (a < b) out.push(line(across(a), y, across(b), y, colour, { "stroke-width": r.strong ? 3 : 2 }));
  for (const [beyond, at, way] of [[r.low < low, low, -1], [r.high > most, most, 1]])
    if (beyond) out.push(svg("path", { d: `M${across(at)} ${y}l${-7 * way} -4v8z`, fill: colour }));
  if (r.value >= low && r.value <= most) out.push(svg("rect", { x: across(r.value) - 4.5, y: y - 4.5, width: 9, height: 9, fill: colour, transform: `rotate(45 ${across(r.value)} ${y})` }));
  return out;
}

/** Bars of errors from the noise upwards: [{title, error, found}]. */
export function bars(width, look, rows) {
  const most = Math.max(1.3, ...rows.map((r) => r.error)) * 1.02, least = 0.997 * Math.min(1, ...rows.map((r) => r.error)), drawn = [];
  const across = (v) => 4 + (width - 60) * (Math.log(v / least) / Math.log(most / least)), noise = across(1);
  let y = 0;
  for (const r of rows) {
    const weight = r.found ? 600 : 400, name = broken(capital(r.title), width - noise - 8, look, 12, weight, 2), at = across(r.error), top = y + 6 + 14 * name.length;
    name.forEach((t, k) => drawn.push(text(noise - 2, y + 14 + 14 * k, t, look.ink, "start", { "font-weight": weight })));
    drawn.push(svg("rect", { x: Math.min(noise, at), y: top, width: Math.max(2, Math.abs(at - noise)), height: 11, rx: 2, fill: r.found ? look.accent : look.faint }),
      text(Math.max(at, noise) + 7, top + 10, r.error.toFixed(2), look.ink), line(noise, top - 3, noise, top + 14, look.ink));
    y = top + 20;
  }
  return canvas(width, y + 18, [...drawn, text(noise - 2, y + 12, "1.00: noise alone", look.faint, "start", { "font-size": 11 })]);
}

/** What an axis of curves with bands goes from and to: all of the curves, and of the bands what does not press them flat. */
function heights(all) {
  const there = all.flatMap((p) => p.ys.flatMap((v, i) => (v === null ? [] : [{ v, by: 2 * p.ses[i] }]))), by = there.map((t) => t.by).sort((a, b) => a - b);
  const [least, greatest] = [Math.min(0, ...there.map((t) => t.v)), Math.max(0, ...there.map((t) => t.v))], room = Math.max(0.6 * (greatest - least), by[by.length >> 1] ?? 1);
  return [Math.max(least - room, Math.min(least, ...there.map((t) => t.v - t.by))), Math.min(greatest + room, Math.max(greatest, ...there.map((t) => t.v + t.by)))];
}

/** Small panels of curves with bands: [{label, xs, ys, ses}], one unit. */
export function panels(width, look, all, unit) {
  const abreast = Math.max(1, Math.min(3, Math.floor(width / 180))), wide = width / abreast, high = 176, drawn = [], [low, most] = heights(all);
  all.forEach((p, n) => {
    const x0 = (n % abreast) * wide + 46, y0 = Math.floor(n / abreast) * high + 10, w = wide - 58, hh = high - 58, there = p.xs.map((_, i) => i).filter((i) => p.ys[i] !== null);
    const shown = there.length > 1 ? there : p.xs.map((_, i) => i), [from, to] = [p.xs[shown[0]], p.xs[shown.at(-1)]], across = (v) => x0 + (w * (v - from)) / (to - from), down = (v) => y0 + hh * (1 - (v - low) / (most - low || 1));
    for (const [v, words] of ticked(ticks(low, most, 4))) drawn.push(line(x0, down(v), x0 + w, down(v), v === 0 ? look.faint : look.line), text(x0 - 5, down(v) + 4, words, look.faint, "end", { "font-size": 10.5 }));
    for (const [v, words] of ticked(ticks(from, to, Math.min(4, w / 50)))) drawn.push(text(across(v), y0 + hh + 14, words, look.faint, "middle", { "font-size": 10.5 }));
    if (there.length) {
      const edge = (way) => there.map((i) => `${across(p.xs[i]).toFixed(1)} ${down(Math.min(most, Math.max(low, p.ys[i] + way * 1.96 * p.ses[i]))).toFixed(1)}`);
      drawn.push(svg("path", { d: `M${edge(1).join("L")}L${edge(-1).reverse().join("L")}Z`, fill: look.error, "fill-opacity": 0.22 }),
        svg("path", { d: `M${there.map((i) => `${across(p.xs[i]).toFixed(1)} ${down(p.ys[i]).toFixed(1)}`).join("L")}`, stroke: look.error, "stroke-width": 2, fill: "none" }),
        there.map((i) => svg("circle", { cx: across(p.xs[i]), cy: down(p.ys[i]), r: 3, fill: look.error })));
    }
    drawn.push(text(x0 + w / 2, y0 + hh + 30, p.label, look.ink, "middle", { "font-size": 11.5 }));
    if (n % abreast === 0) drawn.push(text(0, 0, `[${unit}]`, look.ink, "middle", { transform: `translate(${x0 - 36} ${y0 + hh / 2}) rotate(-90)`, "font-size": 11 }));
  });
  return canvas(width, Math.ceil(all.length / abreast) * high, drawn);
}
