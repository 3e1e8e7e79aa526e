// Estimates with their 95 % intervals: of effects, in sizes of interest; of calibrated values, in standard deviations of what
// was given.

import { canvas, line, short, svg, text, tick, ticks } from "page/draw";
import { significant } from "page/numbers";

const ROW = 24, CLIP = 12;

/** `rows` are [{name, value, low, high, note, strong}], in units of `unit`; the band from −`band` to `band` is
 *  what the words `shaded` say. */
export function forest(width, look, rows, unit, shaded, band = 1) {
  const narrow = width < 560, left = narrow ? 12 : Math.min(340, 0.42 * width), right = narrow ? 12 : 140, high = narrow ? 2 * ROW : ROW;
  const strong = rows.filter((r) => r.strong).flatMap((r) => [r.low, r.high]), ends = rows.flatMap((r) => [r.low, r.high]).filter((v) => Math.abs(v) < CLIP);
  let [low, most] = [Math.min(-1.5 * band, ...strong, ...ends), Math.max(1.5 * band, ...strong, ...ends)].map((v) => v * 1.06);
  const across = (v) => left + ((width - left - right) * (v - low)) / (most - low), end = 30 + high * rows.length, drawn = [];
  drawn.push(svg("rect", { x: across(-band), y: 24, width: across(band) - across(-band), height: end - 24, fill: look.band }));
  for (const v of ticks(low, most, (width - left - right) / 70)) drawn.push(line(across(v), 24, across(v), end, look.line), text(across(v), end + 15, tick(v), look.faint, "middle", { "font-size": 11 }));
  drawn.push(line(across(0), 24, across(0), end, look.faint), text(across(0), 14, shaded, look.faint, "middle", { "font-size": 11 }));
  rows.forEach((r, i) => {
    const y = 24 + high * (i + 0.5) + (narrow ? 8 : 4), colour = r.strong ? look.accent : look.faint, [a, b] = [Math.max(r.low, low), Math.min(r.high, most)];
    const weight = { "font-weight": r.strong ? 600 : 400 };
    drawn.push(narrow ? text(left, y - 11, short(r.name, Math.floor((width - 20) / 7.4 - 0.9 * r.note.length)), look.ink, "start", weight) : text(left - 10, y + 4, short(r.name, Math.floor(left / (r.strong ? 7.4 : 6.7))), look.ink, "end", weight));
    if (a < b) drawn.push(line(across(a), y, across(b), y, colour, { "stroke-width": r.strong ? 3 : 2 }));
    for (const [beyond, at, way] of [[r.low < low, low, -1], [r.high > most, most, 1]])
      if (beyond) drawn.push(svg("path", { d: `M${across(at)} ${y}l${-7 * way} -4v8z`, fill: colour }));
    if (r.value >= low && r.value <= most) drawn.push(svg("rect", { x: across(r.value) - 4.5, y: y - 4.5, width: 9, height: 9, fill: colour, transform: `rotate(45 ${across(r.value)} ${y})` }));
    drawn.push(narrow ? text(width - right, y - 11, r.note, look.faint, "end", { "font-size": 11 }) : text(width - right + 10, y + 4, r.note, r.strong ? look.ink : look.faint, "start", { "font-size": 11.5 }));
  });
  drawn.push(text((left + width - right) / 2, end + 32, unit, look.ink, "middle"));
  return canvas(width, end + 40, drawn);
}

/** A tie: one size alone, the other alone, and the line of shares of both between them. `a` and `b` are {name, value, se}, in
 *  sizes of interest. */
export function pair(width, look, a, b) {
  const left = 60, top = 14, w = Math.min(width - left - 20, 460), hh = Math.min(300, 0.7 * w), reach = (p) => [Math.min(0, 1.15 * (p.value - 2 * p.se)), Math.max(1.3, 1.15 * (p.value + 2 * p.se))];
  const [xs, ys] = [reach(a), reach(b)], across = (v) => left + (w * (v - xs[0])) / (xs[1] - xs[0]), down = (v) => top + hh * (1 - (v - ys[0]) / (ys[1] - ys[0])), drawn = [];
  drawn.push(svg("rect", { x: across(Math.max(-1, xs[0])), y: down(1), width: across(1) - across(Math.max(-1, xs[0])), height: down(Math.max(-1, ys[0])) - down(1), fill: look.band }));
  for (const v of ticks(...xs, w / 70)) drawn.push(line(across(v), top, across(v), top + hh, look.line), text(across(v), top + hh + 16, tick(v), look.faint, "middle"));
  for (const v of ticks(...ys, hh / 45)) drawn.push(line(left, down(v), left + w, down(v), look.line), text(left - 7, down(v) + 4, tick(v), look.faint, "end"));
  drawn.push(line(across(a.value), down(0), across(0), down(b.value), look.accent, { "stroke-width": 2, "stroke-dasharray": "6 4" }));
  drawn.push(line(across(a.value - 1.96 * a.se), down(0), across(a.value + 1.96 * a.se), down(0), look.accent, { "stroke-width": 4 }), line(across(0), down(b.value - 1.96 * b.se), across(0), down(b.value + 1.96 * b.se), look.accent, { "stroke-width": 4 }));
  for (const [x, y] of [[a.value, 0], [0, b.value]]) drawn.push(svg("circle", { cx: across(x), cy: down(y), r: 6, fill: look.accent }));
  drawn.push(text(left + w / 2, top + hh + 36, short(a.name, Math.floor(w / 6.8)), look.ink, "middle"), text(0, 0, short(b.name, Math.floor(hh / 6.8)), look.ink, "middle", { transform: `translate(16 ${top + hh / 2}) rotate(-90)` }));
  return canvas(width, top + hh + 46, drawn);
}

/** Bars of errors from the noise upwards: [{title, error, found}]. */
export function bars(width, look, rows) {
  const high = 40, most = Math.max(1.3, ...rows.map((r) => r.error)) * 1.02, least = 0.997 * Math.min(1, ...rows.map((r) => r.error)), drawn = [];
  const across = (v) => 4 + (width - 60) * (Math.log(v / least) / Math.log(most / least));
  rows.forEach((r, i) => {
    const y = i * high, colour = r.found ? look.accent : look.faint;
    drawn.push(text(4, y + 14, short(r.title, Math.floor(width / 6.3)), look.ink, "start", { "font-weight": r.found ? 600 : 400 }),
      svg("rect", { x: Math.min(across(1), across(r.error)), y: y + 20, width: Math.max(2, Math.abs(across(r.error) - across(1))), height: 11, rx: 2, fill: colour }), text(Math.max(across(r.error), across(1)) + 7, y + 30, r.error.toFixed(2), look.ink));
  });
  const end = rows.length * high;
  return canvas(width, end + 18, [...drawn, line(across(1), 0, across(1), end, look.ink, { "stroke-dasharray": "4 3" }), text(across(1) + 4, end + 12, "1.00: noise alone", look.faint, "start", { "font-size": 11 })]);
}

/** Small panels of curves with bands: [{label, xs, ys, ses}], one unit. */
export function panels(width, look, all, unit) {
  const abreast = width < 480 ? 1 : width < 760 ? 2 : 3, wide = width / abreast, high = 176, drawn = [];
  const values = all.flatMap((p) => p.ys.flatMap((v, i) => (v === null ? [] : [v - 2 * p.ses[i], v + 2 * p.ses[i]]))), [low, most] = [Math.min(0, ...values), Math.max(0, ...values)];
  all.forEach((p, n) => {
    const x0 = (n % abreast) * wide + 46, y0 = Math.floor(n / abreast) * high + 10, w = wide - 58, hh = high - 58, there = p.xs.map((_, i) => i).filter((i) => p.ys[i] !== null);
    const [from, to] = [p.xs[0], p.xs.at(-1)], across = (v) => x0 + (w * (v - from)) / (to - from), down = (v) => y0 + hh * (1 - (v - low) / (most - low || 1));
    for (const v of ticks(low, most, 4)) drawn.push(line(x0, down(v), x0 + w, down(v), v === 0 ? look.faint : look.line), text(x0 - 5, down(v) + 4, tick(v), look.faint, "end", { "font-size": 10.5 }));
    for (const v of ticks(from, to, 4)) drawn.push(text(across(v), y0 + hh + 14, tick(v), look.faint, "middle", { "font-size": 10.5 }));
    if (there.length) {
      const edge = (way) => there.map((i) => `${across(p.xs[i]).toFixed(1)} ${down(p.ys[i] + way * 1.96 * p.ses[i]).toFixed(1)}`);
      drawn.push(svg("path", { d: `M${edge(1).join("L")}L${edge(-1).reverse().join("L")}Z`, fill: look.error, "fill-opacity": 0.22 }),
        svg("path", { d: `M${there.map((i) => `${across(p.xs[i]).toFixed(1)} ${down(p.ys[i]).toFixed(1)}`).join("L")}`, stroke: look.error, "stroke-width": 2, fill: "none" }),
        there.map((i) => svg("circle", { cx: across(p.xs[i]), cy: down(p.ys[i]), r: 3, fill: look.error })));
    }
    drawn.push(text(x0 + w / 2, y0 + hh + 30, p.label, look.ink, "middle", { "font-size": 11.5 }));
    if (n % abreast === 0) drawn.push(text(0, 0, `[${unit}]`, look.ink, "middle", { transform: `translate(${x0 - 36} ${y0 + hh / 2}) rotate(-90)`, "font-size": 11 }));
  });
  return canvas(width, Math.ceil(all.length / abreast) * high, drawn);
}

export const note = (v) => `${significant(v, 2)}`;
