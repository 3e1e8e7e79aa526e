// Curves over time as SVG, for files: what uPlot draws on the page.

import { broken, canvas, course, extent, line, long, present, round, svg, text, tick, ticks } from "page/draw";
import { display, unitText } from "page/numbers";
import { channelOf } from "page/words";

const LEFT = 54, RIGHT = 8;
const APART = 14; // between two ticks, so that their numbers stand free
const MOST = 1500; // points of a curve
const ROOM = 0.12; // of the curves' height that a band may add at either side

/** Panels above one another with one time: [{label, lines: [[name, values, colour, width, dash]], edges, band, height}]; the area
 *  between `edges` [low, high] is shaded, and from −`band` to `band`. */
export function lines(width, look, time, [from, to], panels) {
  const across = (t) => LEFT + ((width - LEFT - RIGHT) * (t - from)) / (to - from), drawn = [];
  const inside = [...time.keys()].filter((i) => time[i] >= from && time[i] <= to), step = Math.max(1, Math.floor(inside.length / MOST));
  const shown = inside.filter((_, k) => k % step === 0), xs = shown.map((i) => across(time[i])), marks = ticks(from, to, width / 90);
  let { top } = key([...panels[0].lines.map(([name, , colour, , dash]) => [name, look[colour], dash]), ...(panels[0].edges ? [["95 % band", null]] : [])], width, look, drawn);
  for (const panel of panels) {
    let [low, high] = panel.reach ?? extent(...panel.lines.map(([, v]) => inside.map((i) => v[i])));
    if (low === high) [low, high] = [low - 1, high + 1];
    if (panel.edges) { // room for the band, as far as it leaves the curves their size
      const [from, to] = extent(...panel.edges.map((edge) => shown.map((i) => edge[i]))), most = ROOM * (high - low);
      [low, high] = [Math.min(low, Math.max(from, low - most)), Math.max(high, Math.min(to, high + most))];
    }
    const down = (v) => top + panel.height * (1 - (v - low) / (high - low));
    if (panel.band) drawn.push(svg("rect", { x: LEFT, width: width - LEFT - RIGHT, y: down(panel.band), height: down(-panel.band) - down(panel.band), fill: look.band }));
    if (panel.edges) drawn.push(svg("path", { d: area(xs, ...panel.edges.map((edge) => shown.map((i) => down(Math.min(Math.max(edge[i], low), high))))), fill: look.band }));
    const values = panel.band && (panel.height * panel.band) / (high - low) > APART ? [-panel.band, 0, panel.band] : ticks(low, high, Math.max(4, panel.height / 40));
    for (const v of values) drawn.push(line(LEFT, down(v), width - RIGHT, down(v), look.line), text(LEFT - 6, down(v) + 4, tick(v), look.faint, "end", { "font-size": 11 }));
    for (const [, values, colour, thick, dash] of panel.lines) {
      const { at, lapse } = present(time, values), own = at.filter((i) => time[i] >= from && time[i] <= to), every = Math.max(1, Math.floor(own.length / MOST)), xs = [], ys = [];
      own.forEach((i, k) => {
        if (k && time[i] - time[own[k - 1]] > lapse) { xs.push(NaN); ys.push(NaN); }
        else if (k % every) return;
        xs.push(across(time[i]));
        ys.push(down(values[i]));
      });
      drawn.push(course(xs, ys, look[colour], { "stroke-width": thick, "stroke-dasharray": dash?.join(" ") }));
    }
    drawn.push(text(0, 0, panel.label, look.ink, "middle", { transform: `translate(12 ${top + panel.height / 2}) rotate(-90)` }));
    top += panel.height + 20;
  }
  for (const t of marks) drawn.push(text(across(t), top + 4, tick(t), look.faint, "middle", { "font-size": 11 }));
  drawn.push(text((LEFT + width - RIGHT) / 2, top + 20, "time [s]", look.ink, "middle"));
  return canvas(width, top + 26, drawn);
}

/** What each line is, [[name, colour, dash]], without a colour a band, in as many rows as it takes; returns where drawing goes on. */
function key(entries, width, look, drawn) {
  let at = LEFT, y = 8;
  for (const [name, colour, dash] of entries) {
    const rows = broken(name, width - LEFT - 25, look, 12, 400, 3), wide = 25 + Math.max(...rows.map((row) => long(row, look)));
    if (at > LEFT && at + wide > width) [at, y] = [LEFT, y + 16];
    drawn.push(colour ? line(at, y, at + 20, y, colour, { "stroke-width": 2, "stroke-dasharray": dash?.join(" ") }) : svg("rect", { x: at, y: y - 5, width: 20, height: 10, fill: look.band }), ...rows.map((row, k) => text(at + 25, y + 4 + 15 * k, row, look.ink)));
    y += 15 * (rows.length - 1);
    at += wide + 19;
  }
  return { top: y + 12 };
}

/** The outline of what lies between two courses over the same places. */
const area = (xs, low, high) => `M${[...xs.map((x, i) => [x, low[i]]), ...xs.map((x, i) => [x, high[i]]).reverse()].map(([x, y]) => `${round(x)} ${round(y)}`).join("L")}Z`;

/** The path from above, forward up. */
export function path(width, look, motion) {
  const every = [["before", motion.before, [2, 3]], ["measured", motion.measured], ["model", motion.model, [7, 4]]].filter(([, p]) => p);
  const [xs, ys] = ["x", "y"].map((c) => extent(...every.map(([, p]) => p[c]))), lengthways = xs[1] - xs[0] > ys[1] - ys[0];
  const [[left, right], [top, bottom]] = lengthways ? [xs, ys] : [ys, [-xs[1], -xs[0]]], frame = 44, room = 0.3;
  const scale = Math.min((width - 2 * frame) / (right - left + 2 * room), 420 / (bottom - top + 2 * room)), height = scale * (bottom - top + 2 * room) + 80;
  const put = (u, v) => [width / 2 + scale * (u - (left + right) / 2), 24 + scale * (v - top + room)], drawn = [], end = height - 50;
  for (const u of ticks(left, right, width / 110)) { const [x] = put(u, top); drawn.push(line(x, 22, x, end, look.line), text(x, end + 16, tick(u), look.faint, "middle", { "font-size": 11 })); }
  for (const v of ticks(top, bottom, Math.min(4, Math.max(1, (scale * (bottom - top)) / 24)))) { const [, y] = put(left, v); drawn.push(line(frame, y, width - 10, y, look.line), text(frame - 6, y + 4, tick(lengthways ? v : -v), look.faint, "end", { "font-size": 11 })); }
  let at = frame;
  for (const [name, p, dash] of every) {
    const points = [...p.x.keys()].filter((i) => i % Math.max(1, Math.floor(p.x.length / 700)) === 0).map((i) => (lengthways ? put(p.x[i], p.y[i]) : put(p.y[i], -p.x[i])));
    drawn.push(course(points.map((q) => q[0]), points.map((q) => q[1]), look[name], { "stroke-width": 2, "stroke-dasharray": dash?.join(" ") }));
    drawn.push(line(at, 8, at + 20, 8, look[name], { "stroke-width": 2, "stroke-dasharray": dash?.join(" ") }), text(at + 25, 12, name, look.ink));
    at += 44 + long(name, look);
  }
  drawn.push(text(width / 2, height - 14, lengthways ? "forward [m]; downwards: to the right [m]" : "to the right [m]; upwards: forward [m]", look.ink, "middle"));
  return canvas(width, height, drawn);
}

/** A channel's name with its unit. */
export const labelled = (record) => `${channelOf(record.name)} [${unitText(display(record).unit) || "1"}]`;
