// The error falling, step by step, on a logarithmic axis from the noise.

import { broken, canvas, line, long, round, svg, text, tick, whole } from "page/draw";
import { rms } from "page/numbers";

const MARKS = [0.8, 1, 1.2, 1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50, 100, 200, 500, 1000];

const NARROW = 110; // a step beside which numbers have no place
const ROW = 14; // of words

/** Steps beside one another, where each has room for the words that name it, and below one another elsewhere. `steps` are [{step, name, fit, heldout}] of the search; `now` {fit, heldout} is drawn beside where it equals none. */
export function staircase(width, look, steps, now) {
  const every = now ? [...steps, { name: "as set now", ...now, now: true }] : steps, left = 46, right = 14, high = 210, top = 34;
  const values = every.flatMap((s) => [s.fit, s.heldout]).filter(Number.isFinite), [least, most] = [Math.min(0.9, ...values) * 0.97, Math.max(1.5, ...values) * 1.18];
  const wide = (width - left - right) / every.length, shown = MARKS.filter((v) => v > least && v < most), spaced = shown.filter((v) => v === 1 || shown.length < 8 || /^[125]0*$/.test(String(v)));
  const words = every.flatMap((s) => s.name.split(/\s+/));
  if (words.some((w) => long(w, look, 11) > wide - 5)) return rows(width, look, every, spaced, [least, most]);
  const down = (v) => top + high * (1 - Math.log(v / least) / Math.log(most / least)), under = wide < NARROW ? 34 : 22;
  const drawn = spaced.map((v) => [line(left, down(v), width - right, down(v), v === 1 ? look.ink : look.line, v === 1 ? { "stroke-dasharray": "5 4" } : {}), text(left - 7, down(v) + 4, tick(v), look.faint, "end")]);
  drawn.push(text(left + 4, down(1) - 5, "noise alone", look.faint, "start", { "font-size": 11 })); // falling, the steps leave this corner free
  const told = []; // in front of all lines
  const size = whole(every.map((s) => s.name), wide - 5, look, [12, 11]), names = every.map((s) => broken(s.name, wide - 5, look, size, 400, 7));
  every.forEach((s, i) => {
    const x = left + wide * i, middle = x + wide / 2, next = every[i + 1], gap = Math.min(22, wide / 4);
    for (const [key, filled] of [["fit", false], ["heldout", true]]) {
      const v = s[key];
      if (!Number.isFinite(v)) continue;
      const side = filled ? gap / 2 : -gap / 2, colour = s.now ? look.accent : look.model;
      if (next && Number.isFinite(next[key]) && !next.now) drawn.push(line(middle + side, down(v), left + wide * (i + 1.5) + side, down(next[key]), look.model, { "stroke-width": 1.5, "stroke-dasharray": filled ? null : "3 3", opacity: 0.75 }));
      drawn.push(svg("circle", { cx: middle + side, cy: down(v), r: 5.5, fill: filled ? colour : look.paper, stroke: colour, "stroke-width": 2 }));
      const weight = { "font-weight": filled ? 600 : 400 };
      if (wide < NARROW) told.push(backed(middle + side, down(v) + ((s.heldout >= s.fit) === filled ? -11 : 20), rms(v), look, "middle", weight));
      else told.push(backed(middle + side + (filled ? 8 : -7), down(v) + (filled ? -7 : 17), rms(v), look, filled ? "start" : "end", weight));
    }
    names[i].forEach((t, k) => drawn.push(text(middle, top + high + under + 14 * k, t, look.ink, "middle", { "font-size": size })));
  });
  drawn.push(told, key(left, look));
  drawn.push(text(0, 0, "error, noise = 1", look.ink, "middle", { transform: `translate(12 ${top + high / 2}) rotate(-90)` }));
  return canvas(width, top + high + under + 6 + 14 * Math.max(...names.map((n) => n.length)), drawn);
}

/** The same with a row for each step: its name, both errors on an axis across, and both numbers. */
function rows(width, look, every, marks, [least, most]) {
  const left = 0.4 * width, right = 84, across = (v) => left + (width - left - right) * (Math.log(v / least) / Math.log(most / least)), top = 44, drawn = [], dots = [];
  const names = every.map((s) => broken(s.name, left - 18, look, 12, 400, 4)), highs = names.map((n) => Math.max(30, ROW * n.length + 12)), end = top + highs.reduce((a, b) => a + b, 0);
  const few = marks.filter((v) => v === 1 || /^[125]0*$/.test(String(v)));
  for (const v of few) drawn.push(line(across(v), top, across(v), end, v === 1 ? look.ink : look.line, v === 1 ? { "stroke-dasharray": "5 4" } : {}), text(across(v), end + 15, tick(v), look.faint, "middle", { "font-size": 11 }));
  drawn.push(text(width - 46, top - 8, "held out", look.faint, "end", { "font-size": 11 }), text(width, top - 8, "fitted", look.faint, "end", { "font-size": 11 }));
  let y = top;
  every.forEach((s, i) => {
    const middle = y + highs[i] / 2, below = every[i + 1] && middle + (highs[i] + highs[i + 1]) / 2, colour = s.now ? look.accent : look.model;
    names[i].forEach((t, k) => drawn.push(text(left - 12, middle + 4 + ROW * (k - (names[i].length - 1) / 2), t, look.ink, "end")));
    for (const [key, filled] of [["fit", false], ["heldout", true]]) {
      const v = s[key], next = every[i + 1]?.[key], own = filled ? -4 : 4;
      drawn.push(text(filled ? width - 46 : width, middle + 4, rms(v), look.ink, "end", { "font-weight": filled ? 600 : 400 }));
      if (!Number.isFinite(v)) continue;
      if (Number.isFinite(next) && !every[i + 1].now) drawn.push(line(across(v), middle + own, across(next), below + own, look.model, { "stroke-width": 1.5, "stroke-dasharray": filled ? null : "3 3", opacity: 0.75 }));
      dots.push(svg("circle", { cx: across(v), cy: middle + own, r: 5, fill: filled ? colour : look.paper, stroke: colour, "stroke-width": 2 }));
    }
    y += highs[i];
  });
  return canvas(width, end + 38, [...drawn, dots, key(6, look), text(across(Math.sqrt(least * most)), end + 32, "error; 1 is noise alone", look.ink, "middle")]);
}

/** Which dot is of which runs. */
function key(left, look) {
  const second = left + 40 + long("runs held out", look);
  return [svg("circle", { cx: left + 6, cy: 10, r: 5, fill: look.model, stroke: look.model }), text(left + 16, 14, "runs held out", look.ink),
    svg("circle", { cx: second, cy: 10, r: 4.5, fill: look.paper, stroke: look.model, "stroke-width": 2 }), text(second + 10, 14, "fitted runs", look.ink)];
}

/** A number on a ground of its own, so that no line runs through it. */
function backed(x, y, words, look, anchor, weight) {
  const wide = long(words, look, 12, weight["font-weight"]) + 2, from = { start: x - 1, middle: x - wide / 2, end: x - wide + 1 }[anchor];
  return [svg("rect", { x: round(from), y: round(y - 10), width: round(wide), height: 12, fill: look.paper, opacity: 0.8 }), text(x, y, words, look.ink, anchor, weight)];
}
