// Errors put together over runs and channels, as inference/residual/compare.py does. 1.0 is the noise floor.

const BINS = 4;

/** Whitened RMS over all channels of the runs with this role; NaN where there are none. */
export function together(runs, results, role) {
  let sum = 0, count = 0;
  runs.forEach((run, i) => {
    if (run.role !== role || !results[i]) return;
    for (const c of Object.keys(results[i].squares)) { sum += results[i].squares[c]; count += results[i].counts[c]; }
  });
  return count ? Math.sqrt(sum / count) : NaN;
}

/** Whitened RMS by channel of one run. */
export function byChannel(result) {
  return Object.fromEntries(Object.keys(result.squares).map((c) => [c, Math.sqrt(result.squares[c] / result.counts[c])]));
}

/** [{name, from, to, rms, share}] over bins of a regime that hold equally many samples: whitened RMS, and share of the
 *  excess Σ(e² − 1). */
export function excessBy(regimes, allRuns, allResults) {
  const runs = allRuns.filter((_, i) => allResults[i]), results = allResults.filter(Boolean);
  const squares = results.map((r) => squaresOf(r));
  const total = squares.reduce((sum, s) => sum + s.total - s.counted, 0);
  const named = regimes.filter((r) => r.output).map((r) => [r.name, (i) => results[i].results[r.output]]);
  if (runs.some((r) => Object.keys(r.inputs).some((n) => n.startsWith("push.")))) named.push(["push", (i) => pushOf(runs[i])]);
  return named.flatMap(([name, series]) => binned(name, runs.map((_, i) => series(i)), squares, total));
}

function binned(name, values, squares, total) {
  const sorted = Float64Array.from(values.flatMap((v) => [...v])).sort();
  const edges = [...new Set(Array.from({ length: BINS + 1 }, (_, k) => quantile(sorted, k / BINS)))];
  if (edges.length < 2) return [];
  const sums = new Float64Array(edges.length - 1), counts = new Float64Array(edges.length - 1);
  values.forEach((series, i) => {
    for (let j = 0; j < series.length; j++) {
      let bin = edges.findLastIndex((edge) => edge <= series[j]);
      bin = Math.min(Math.max(bin, 0), sums.length - 1);
      sums[bin] += squares[i].sum[j];
      counts[bin] += squares[i].count[j];
    }
  });
  return [...sums].map((sum, k) => ({ name, from: edges[k], to: edges[k + 1], rms: Math.sqrt(sum / counts[k]), share: total ? (sum - counts[k]) / total : 0 }));
}

/** Squared errors summed over channels, and how many there are, by sample and altogether. */
function squaresOf(result) {
  const series = Object.values(result.errors), n = series[0].length, sum = new Float64Array(n), count = new Uint8Array(n);
  for (const e of series)
    for (let i = 0; i < n; i++) if (!Number.isNaN(e[i])) { sum[i] += e[i] * e[i]; count[i]++; }
  return { sum, count, total: sum.reduce((a, b) => a + b, 0), counted: count.reduce((a, b) => a + b, 0) };
}

function pushOf(run) {
  const pushes = Object.entries(run.inputs).filter(([n]) => n.startsWith("push.")).map(([, v]) => v);
  return run.time.map((_, i) => pushes.reduce((sum, p) => sum + p[i], 0));
}

function quantile(sorted, q) {
  const at = q * (sorted.length - 1), low = Math.floor(at), high = Math.ceil(at);
  return sorted[low] + (sorted[high] - sorted[low]) * (at - low);
}
