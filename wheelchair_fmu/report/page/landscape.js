// The likelihood about the estimates: by each size alone, and by the sizes of two rivals together.

import { broken, canvas, course, line, long, svg, text, ticked, ticks } from "page/draw";

const HIGH = 236;

/** A curve's heights about its lowest, as far as it rises to `most` on either side: beyond that a search may have found another
 *  model, which would say nothing of this one. Others are null. */
export function rising(heights, most) {
  const there = heights.map((v) => v ?? Infinity), least = there.indexOf(Math.min(...there)), out = heights.map(() => null);
  for (const way of [-1, 1]) for (let i = least, on = true; on && i in heights; i += way) [out[i], on] = [heights[i], there[i] < most];
  return out;
}

/** Curves of heights over sizes: [{label, xs, ys, estimate}], with the level below which 95 % lie; three abreast at most. */
export function profiles(width, look, all, level) {
  const abreast = Math.max(1, Math.min(all.length, 3, Math.floor(width / 240))), wide = width / abreast, most = 2.4 * level, drawn = [];
  all.forEach((p, n) => {
    const x0 = (n % abreast) * wide + 46, y0 = Math.floor(n / abreast) * (HIGH + 10) + 10, w = Math.min(wide - 60, 460), hh = HIGH - 70;
    const from = p.xs[0], to = p.xs.at(-1), across = (v) => x0 + (w * (v - from)) / (to - from || 1), down = (v) => y0 + hh * (1 - v / most), curve = smooth(p.xs.map(across), rising(p.ys, most).map((v) => (v === null ? NaN : down(v))));
    for (const [v, words] of ticked(ticks(0, most, 4))) drawn.push(line(x0, down(v), x0 + w, down(v), look.line), text(x0 - 6, down(v) + 4, words, look.faint, "end", { "font-size": 11 }));
    for (const [v, words] of ticked(ticks(from, to, Math.max(3, w / 80)))) drawn.push(text(across(v), y0 + hh + 16, words, look.faint, "middle", { "font-size": 11 }));
    drawn.push(line(x0, down(level), x0 + w, down(level), look.ink, { "stroke-dasharray": "5 4" }), text(x0 + w, down(level) + 13, "95 %", look.faint, "end", { "font-size": 11 }));
    drawn.push(line(across(p.estimate), y0, across(p.estimate), y0 + hh, look.faint), course(curve[0], curve[1].map((y) => (y < y0 ? NaN : Math.min(y, y0 + hh))), look.accent, { "stroke-width": 2 }));
    broken(p.label, wide - 36, look, 12, 400, 2).forEach((t, k) => drawn.push(text(x0 + w / 2, y0 + hh + 34 + 14 * k, t, look.ink, "middle")));
    if (n % abreast === 0) drawn.push(text(0, 0, "how much worse it fits", look.ink, "middle", { transform: `translate(${x0 - 33} ${y0 + hh / 2}) rotate(-90)` }));
  });
  return canvas(width, Math.ceil(all.length / abreast) * (HIGH + 10), drawn);
}

/** Where a curve of heights rises through a level either side of its lowest point; NaN where it ends before. */
export function crossings(xs, ys, level) {
  const root = ys.map((y) => (y === null ? Infinity : Math.sqrt(Math.max(y, 0)))), least = root.indexOf(Math.min(...root)), goal = Math.sqrt(level); // of a parabola, straight
  return [-1, 1].map((way) => {
    for (let i = least; xs[i + way] !== undefined; i += way)
      if (root[i + way] >= goal) return Number.isFinite(root[i + way]) ? xs[i] + ((goal - root[i]) / (root[i + way] - root[i])) * (xs[i + way] - xs[i]) : NaN;
    return NaN;
  });
}

/** Does a curve stay far under its level from an end that is told, below the lowest point (0) or above it (1), to where it is
 *  drawn no more? */
export function stays({ values, heights, level }, end, side) {
  const beyond = heights.filter((_, i) => (side ? values[i] >= end : values[i] <= end));
  return beyond.length > 1 && beyond.every((h) => h !== null && h < FAR_UNDER * level);
}

const FAR_UNDER = 0.5;
const BETWEEN = 8; // points drawn from one of a curve to the next

/** A curve through points as cubics go through four of them at a time, [xs, ys]; straight beside a gap or an end. */
function smooth(xs, ys) {
  const out = [[], []], at = (v, i) => (Number.isFinite(v[i]) ? v[i] : NaN);
  for (let i = 0; i < xs.length; i++)
    for (let k = 0; k < (i + 1 < xs.length ? BETWEEN : 1); k++) {
      const s = k / BETWEEN;
      [xs, ys].forEach((v, axis) => {
        const [b, c] = [at(v, i), at(v, i + 1)], around = [ys[i - 1], ys[i], ys[i + 1], ys[i + 2]].every(Number.isFinite), [a, d] = around ? [v[i - 1], v[i + 2]] : [2 * b - c, 2 * c - b];
        out[axis].push(k ? b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a))) : b);
      });
    }
  return out;
}

/** Where a height crosses `level` in the cells of a grid, as pieces [[x, y], [x, y]] between places of the grid. */
export function contour(heights, about, level) {
  const pieces = [], there = (v) => (v === null ? 1e9 : v);
  for (let j = 0; j + 1 < about.length; j++)
    for (let i = 0; i + 1 < about.length; i++) {
      const corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([a, b]) => [about[a], about[b], there(heights[b][a])]), cut = [];
      corners.forEach(([x, y, v], k) => {
        const [ox, oy, other] = corners[(k + 1) % 4];
        if (v < level === other < level) return;
        const part = (Math.sqrt(level) - Math.sqrt(Math.max(v, 0))) / (Math.sqrt(Math.max(other, 0)) - Math.sqrt(Math.max(v, 0))); // of a parabola, straight
        cut.push([x + part * (ox - x), y + part * (oy - y)]);
      });
      for (let k = 0; k + 1 < cut.length; k += 2) pieces.push([cut[k], cut[k + 1]]);
    }
  return pieces;
}

/** Pieces that meet, one after another, as courses [[x, y], ...]. */
export function joined(pieces) {
  const key = ([x, y]) => `${x.toFixed(6)} ${y.toFixed(6)}`, left = new Set(pieces), out = [];
  for (const piece of pieces) {
    if (!left.delete(piece)) continue;
    const points = [...piece];
    for (let more = true; more; ) {
      more = false;
      for (const other of left) {
        const [a, b] = other.map(key), first = key(points[0]), last = key(points.at(-1));
        if (a === last || b === last) points.push(other[a === last ? 1 : 0]);
        else if (a === first || b === first) points.unshift(other[a === first ? 1 : 0]);
        else continue;
        left.delete(other);
        more = true;
      }
    }
    out.push(points);
  }
  return out;
}

const FINER = 6; // steps drawn from one of the grid to the next

/** Heights over a finer grid, [about, heights]: the parabola that lies nearest to them, and between their places what they differ
 *  from it by. So a contour is smooth, and goes on where no model could be asked, beyond a bound. */
export function finer(about, heights) {
  const terms = (u, v) => [1, u, v, u * u, u * v, v * v], known = [];
  heights.forEach((row, j) => row.forEach((h, i) => { if (h !== null) known.push([about[i], about[j], h]); }));
  const weights = known.map(([, , h]) => 1 / (1 + h)), a = terms(0, 0).map((_, p) => terms(0, 0).map((__, q) => known.reduce((sum, [u, v], k) => sum + weights[k] * terms(u, v)[p] * terms(u, v)[q], p === q ? 1e-9 : 0)));
  const fit = solved(a, terms(0, 0).map((_, p) => known.reduce((sum, [u, v, h], k) => sum + weights[k] * terms(u, v)[p] * h, 0)));
  const parabola = (u, v) => terms(u, v).reduce((sum, t, p) => sum + t * fit[p], 0), rest = heights.map((row, j) => row.map((h, i) => (h === null ? 0 : h - parabola(about[i], about[j]))));
  const places = Array.from({ length: (about.length - 1) * FINER + 1 }, (_, k) => [Math.min(Math.floor(k / FINER), about.length - 2), k]).map(([i, k]) => [i, k / FINER - i]);
  const fine = places.map(([i, s]) => about[i] + s * (about[i + 1] - about[i]));
  return [fine, places.map(([j, t], b) => places.map(([i, s], a) => Math.max(0, parabola(fine[a], fine[b]) + (1 - t) * ((1 - s) * rest[j][i] + s * rest[j][i + 1]) + t * ((1 - s) * rest[j + 1][i] + s * rest[j + 1][i + 1]))))];
}

/** A small system of equations, by elimination with the greatest pivot. */
function solved(a, b) {
  const m = a.map((row, i) => [...row, b[i]]), n = b.length;
  for (let i = 0; i < n; i++) {
    const most = m.slice(i).reduce((best, row, k) => (Math.abs(row[i]) > Math.abs(m[best][i]) ? k + i : best), i);
    [m[i], m[most]] = [m[most], m[i]];
    for (let k = 0; k < n; k++) if (k !== i) { const by = m[k][i] / m[i][i]; for (let c = i; c <= n; c++) m[k][c] -= by * m[i][c]; }
  }
  return m.map((row, i) => row[n] / row[i]);
}

/** Two sizes together: contours of 50 and 95 % about the best, and either size alone on its axis. `pair` is the landscape's
 *  with `names`, `deltas`, `bounds` [[least, greatest], ...] and the sizes that each has `alone`; both axes are in the smallest sizes that would matter. */
export function together(width, look, pair) {
  const left = 70, top = 14, w = Math.min(width - left - 20, 460), hh = Math.min(300, 0.7 * w), { best, axes, deltas, bounds } = pair, [about, heights] = finer(pair.about, pair.heights);
  const at = ([u, v]) => [0, 1].map((k) => (best[k] + axes[k][0] * u + axes[k][1] * v) / deltas[k]);
  const lines = [[pair.middle, "4 3"], [pair.level, null]].map(([level, dash]) => [joined(contour(heights, about, level)).map((points) => within(points.map(at), bounds)), dash]);
  const alone = (pair.alone ?? []).map((v, k) => (k ? [0, v / deltas[1]] : [v / deltas[0], 0])).filter((q) => q.every(Number.isFinite));
  const points = [[0, 0], [1, 1], ...alone, ...lines.flatMap(([pieces]) => pieces.flat()).filter(([v]) => Number.isFinite(v))], reach = (k) => { const vs = points.map((p) => p[k]), low = Math.min(...vs), high = Math.max(...vs); return [low - 0.08 * (high - low), high + 0.08 * (high - low)]; };
  const [xs, ys] = [reach(0), reach(1)], across = (v) => left + (w * (v - xs[0])) / (xs[1] - xs[0]), down = (v) => top + hh * (1 - (v - ys[0]) / (ys[1] - ys[0])), drawn = [];
  const [x0, x1] = [Math.max(-1, xs[0]), Math.min(1, xs[1])], [y0, y1] = [Math.max(-1, ys[0]), Math.min(1, ys[1])];
  drawn.push(svg("rect", { x: across(x0), y: down(y1), width: across(x1) - across(x0), height: down(y0) - down(y1), fill: look.band }));
  for (const [v, words] of ticked(ticks(...xs, w / 70))) drawn.push(line(across(v), top, across(v), top + hh, v === 0 ? look.faint : look.line), text(across(v), top + hh + 16, words, look.faint, "middle"));
  for (const [v, words] of ticked(ticks(...ys, hh / 45))) drawn.push(line(left, down(v), left + w, down(v), v === 0 ? look.faint : look.line), text(left - 7, down(v) + 4, words, look.faint, "end"));
  for (const [x, y] of alone) drawn.push(svg("circle", { cx: across(x), cy: down(y), r: 6, fill: "none", stroke: look.faint, "stroke-width": 1.5 })); // under the lines, which may end there
  for (const [pieces, dash] of lines) for (const points of pieces) drawn.push(course(points.map((q) => across(q[0])), points.map((q) => down(q[1])), look.accent, { "stroke-width": 2, "stroke-dasharray": dash }));
  const [a, b] = at([0, 0]);
  drawn.push(svg("circle", { cx: across(a), cy: down(b), r: 4.5, fill: look.accent }));
  const [below, beside] = [measured(pair.names[0], w + 40, look), measured(pair.names[1], hh, look)];
  below.forEach((t, k) => drawn.push(text(left + w / 2, top + hh + 36 + 14 * k, t, look.ink, "middle")));
  beside.forEach((t, k) => drawn.push(text(0, 0, t, look.ink, "middle", { transform: `translate(${14 + 14 * k} ${top + hh / 2}) rotate(-90)` })));
  return canvas(width, top + hh + 32 + 14 * below.length, drawn);
}

/** A course as far as it lies within bounds, to the very bounds, with a gap where it does not. */
function within(points, bounds) {
  const out = [], inside = (q) => q.every((v, k) => v >= bounds[k][0] && v <= bounds[k][1]);
  points.forEach((q, i) => {
    const before = points[i - 1];
    if (before && inside(before) !== inside(q)) {
      let [kept, lost] = inside(q) ? [q, before] : [before, q];
      for (let n = 0; n < 30; n++) { const middle = kept.map((v, k) => (v + lost[k]) / 2); if (inside(middle)) kept = middle; else lost = middle; }
      out.push(kept);
    }
    out.push(inside(q) ? q : [NaN, NaN]);
  });
  return out;
}

/** Lines of a name with what its axis counts, or, where that has no place, of the name alone. */
const measured = (name, room, look) => (long(`${name}, in sizes that matter`, look) <= room ? [`${name}, in sizes that matter`] : broken(name, room, look, 12, 400, 2));
