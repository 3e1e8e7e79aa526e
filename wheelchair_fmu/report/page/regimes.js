// Errors of one channel against what was going on: speed, yaw rate, force, heading, push.

import { canvas, line, svg, text, ticked, ticks } from "page/draw";
import { display, unitText } from "page/numbers";
import { capital } from "page/words";

const BINS = 14, LEAST = 25; // bins of a panel, and samples in one
const PERFECT = 2, WIDEST = 2.5; // errors of a perfect model, noise = 1, and what an axis has at least
const WITHIN = 0.025; // of the samples of a bin lie below the band, and as many above

/** [{label, xs, means, lows, highs}] by regime: places with equally many samples of all runs, the mean error there, and between
 *  which errors 95 % of them lie. */
export function against(regimes, runs, results, channel) {
  const there = runs.map((run, i) => [run, results[i]]).filter(([, r]) => r?.errors?.[channel] && r.results);
  return regimes.map((regime) => {
    const { factor, unit } = display(regime), xs = [], es = [];
    for (const [run, r] of there) {
      const x = regime.output ? r.results[regime.output] : total(run), e = r.errors[channel];
      if (x) for (let k = 0; k < e.length; k++) if (Number.isFinite(x[k] + e[k])) { xs.push(x[k] * factor); es.push(e[k]); }
    }
    return { label: `${capital(regime.name)} [${unitText(unit) || "1"}]`, ...binned(xs, es) };
  }).filter((p) => p.xs.length > 2);
}

/** Errors `es` at places `xs`, in bins of about as many. */
function binned(xs, es) {
  const sorted = Float64Array.from(xs).sort(), count = Math.min(BINS, Math.floor(xs.length / LEAST)), out = { xs: [], means: [], lows: [], highs: [] };
  const edges = [...new Set(Array.from({ length: count }, (_, k) => sorted[Math.floor((k * xs.length) / count)]))], bins = edges.map(() => ({ x: 0, e: 0, all: [] }));
  xs.forEach((x, i) => {
    const bin = bins[edges.findLastIndex((edge) => edge <= x)];
    bin.x += x; bin.e += es[i]; bin.all.push(es[i]);
  });
  for (const { x, e, all } of bins) {
    const own = Float64Array.from(all).sort(), n = own.length;
    if (n < LEAST) continue;
    for (const [name, v] of [["xs", x / n], ["means", e / n], ["lows", own[Math.floor(WITHIN * n)]], ["highs", own[Math.ceil((1 - WITHIN) * n) - 1]]]) out[name].push(v);
  }
  return out;
}

/** All pushes of a run together; nothing where none was recorded. */
function total(run) {
  const pushes = Object.entries(run.inputs).filter(([n]) => n.startsWith("push.")).map(([, v]) => v);
  return pushes.length ? run.time.map((_, i) => pushes.reduce((sum, p) => sum + p[i], 0)) : null;
}

/** Small panels of these, all of one height of error. */
export function drawn(width, look, panels) {
  const abreast = Math.max(1, Math.min(panels.length, width < 900 ? (panels.length === 4 ? 2 : 3) : 5, Math.floor(width / 165))), wide = width / abreast, high = 190, out = [];
  const [low, most] = [-1, 1].map((way) => way * 1.05 * Math.max(WIDEST, ...panels.flatMap((p) => [...p.lows, ...p.highs].map((v) => way * v))));
  panels.forEach((p, n) => {
    const x0 = (n % abreast) * wide + 44, y0 = Math.floor(n / abreast) * high + 8, w = wide - 56, hh = high - 58, [from, to] = [p.xs[0], p.xs.at(-1)];
    const across = (v) => x0 + (w * (v - from)) / (to - from), down = (v) => y0 + (hh * (most - v)) / (most - low), points = (ys) => ys.map((y, i) => `${across(p.xs[i]).toFixed(1)} ${down(y).toFixed(1)}`);
    for (const [v, words] of ticked(ticks(low, most, 5))) out.push(line(x0, down(v), x0 + w, down(v), v === 0 ? look.faint : look.line), text(x0 - 5, down(v) + 4, words, look.faint, "end", { "font-size": 10.5 }));
    for (const [v, words] of ticked(ticks(from, to, Math.max(2, w / 55)))) out.push(text(across(v), y0 + hh + 14, words, look.faint, "middle", { "font-size": 10.5 }));
    for (const v of [-PERFECT, PERFECT]) out.push(line(x0, down(v), x0 + w, down(v), look.ink, { "stroke-dasharray": "5 4" }));
    out.push(svg("path", { d: `M${points(p.highs).join("L")}L${points(p.lows).reverse().join("L")}Z`, fill: look.error, "fill-opacity": 0.14 }), svg("path", { d: `M${points(p.means).join("L")}`, stroke: look.error, "stroke-width": 2, fill: "none" }));
    out.push(text(x0 + w / 2, y0 + hh + 31, p.label, look.ink, "middle", { "font-size": 11.5 }));
    if (n % abreast === 0) out.push(text(0, 0, "error ÷ noise", look.ink, "middle", { transform: `translate(${x0 - 32} ${y0 + hh / 2}) rotate(-90)`, "font-size": 11 }));
  });
  return canvas(width, Math.ceil(panels.length / abreast) * high, out);
}
