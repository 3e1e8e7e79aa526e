// Sizes of what is ticked and the calibrated values, fitted together to the fitted runs: Gauss and Newton, with the priors of
// inference/estimation/fit.py.

const ROUNDS = 8;
const ENOUGH = 0.5; // fall of the sum of squares that slopes promise, below which nothing more is gained
const GROUPED = 10; // sizes of interest: standard deviation of each of several sizes of one effect
const STEP = 0.02; // of a parameter's scale, for slopes
const NEARLY = 0.01; // sizes of interest that are nearly nothing, but have a slope
const LEFT = 1e-7; // the same of an effect that a fit has left nothing of, which stays put in: the page shows so little as 0

/** Resolves to values that are most likely where `names` are free, from the best of these `starts`; `go()` false ends it early. */
export async function refit(pool, campaign, starts, names, go = () => true) {
  const [values] = starts, problem = names.map((name) => parameter(campaign, name, names, values)), runs = fitted(campaign);
  const at = (x) => ({ ...values, ...Object.fromEntries(problem.map((p, k) => [name(p), x[k]])) });
  const summed = async (x) => {
    const steps = problem.map((p, k) => [name(p), x[k] + STEP * p.scale <= p.upper ? STEP * p.scale : -STEP * p.scale]);
    const parts = await Promise.all(runs.map((run) => pool.later({ run, values: at(x), slopes: steps }, true)));
    return total(parts, problem, x);
  };
  const begun = [];
  let lost = null;
  for (const start of starts) {
    if (!go()) break;
    const from = problem.map((p) => clamp(p, start[name(p)] ?? p.start));
    await summed(from).then((found) => begun.push([from, found]), (error) => { lost = error; });
  }
  if (!begun.length && lost) throw lost;
  if (!begun.length) return values;
  let [theta, here] = begun.reduce((a, b) => (b[1].squares < a[1].squares ? b : a));
  for (let round = 0; round < ROUNDS && go(); round++) {
    const step = bounded(here, problem, theta);
    const promised = step.reduce((sum, d, k) => sum - d * here.gradient[k], 0);
    if (!(promised > ENOUGH)) break;
    let next = null;
    for (const part of [1, 0.5, 0.2]) {
      const trial = theta.map((v, k) => clamp(problem[k], v + part * step[k])), found = await summed(trial).catch(() => null);
      if (found && found.squares < here.squares) { next = [trial, found]; break; }
      if (!go()) break;
    }
    if (!next) break;
    [theta, here] = next;
  }
  return at(theta);
}

/** Values to begin a fit at: as they are, and with each of these effects at nearly nothing, beside which what was fitted before
 *  still holds. A size that was fitted alone may be far off beside others. */
export function starts(values, effects) {
  const nearly = (p) => [p.name, (Math.sign(values[p.name]) || 1) * NEARLY * p.delta];
  return [values, ...effects.map((e) => ({ ...values, ...Object.fromEntries(e.parameters.filter((p) => values[p.name]).map(nearly)) }))];
}

/** The same values, in which what was put in is still in, though a fit has left nothing of it. */
export function kept(values, effects) {
  const gone = effects.filter((e) => e.parameters.every((p) => !values[p.name]));
  return { ...values, ...Object.fromEntries(gone.map((e) => [e.parameters[0].name, LEFT * e.parameters[0].delta])) };
}

const name = (p) => p.name;
const clamp = (p, v) => Math.min(Math.max(v, p.lower), p.upper);

function fitted({ runs }) {
  const found = runs.map((_, i) => i).filter((i) => runs[i].role !== "holdout");
  return found.length ? found : runs.map((_, i) => i);
}

/** Bounds, scale and prior of a parameter. */
function parameter(campaign, name, names, values) {
  const record = [...campaign.calibrated, ...campaign.effects.flatMap((e) => e.parameters)].find((p) => p.name === name) ?? {};
  const given = campaign.diagnosis.calibration?.[name], group = name.slice(0, name.lastIndexOf(".") + 1), start = record.default ?? 0;
  const several = name.startsWith("effect.") && names.filter((n) => n.startsWith(group)).length > 1;
  const sd = given?.prior_sd ?? (several && record.delta ? GROUPED * record.delta : Infinity);
  const scale = record.delta || (Number.isFinite(sd) ? sd / 2 : Math.abs(values[name]) / 10 || 0.01);
  const reach = given?.prior_sd ? 4 * given.prior_sd : Infinity, mean = given?.prior ?? start;
  return { name, start, mean, sd, scale, lower: Math.max(record.lower ?? -Infinity, mean - reach), upper: Math.min(record.upper ?? Infinity, mean + reach) };
}

/** Normal equations of all runs and the priors. The step d solves matrix · d = −gradient. */
function total(parts, problem, x) {
  const k = problem.length, matrix = Array.from({ length: k }, () => new Float64Array(k)), gradient = new Float64Array(k);
  let squares = 0;
  for (const { jtj, jtr, squares: own } of parts) {
    squares += own;
    for (let a = 0; a < k; a++) { gradient[a] += jtr[a]; for (let b = 0; b < k; b++) matrix[a][b] += jtj[a * k + b]; }
  }
  problem.forEach((p, a) => {
    if (!Number.isFinite(p.sd)) return;
    matrix[a][a] += p.sd ** -2;
    gradient[a] += (x[a] - p.mean) / p.sd ** 2;
    squares += ((x[a] - p.mean) / p.sd) ** 2;
  });
  return { matrix, gradient, squares };
}

/** The step that slopes want; what would leave its bounds goes as far as they are, and the rest is solved again. */
function bounded({ matrix, gradient }, problem, theta) {
  const step = new Float64Array(theta.length), held = new Set();
  for (let round = 0; round <= theta.length; round++) {
    const free = [...theta.keys()].filter((k) => !held.has(k));
    const solved = solve(free.map((a) => free.map((b) => matrix[a][b])), free.map((a) => -gradient[a] - [...held].reduce((sum, b) => sum + matrix[a][b] * step[b], 0)));
    const out = free.filter((k, i) => theta[k] + solved[i] < problem[k].lower - 1e-12 || theta[k] + solved[i] > problem[k].upper + 1e-12);
    free.forEach((k, i) => { step[k] = clamp(problem[k], theta[k] + solved[i]) - theta[k]; });
    if (!out.length) break;
    out.forEach((k) => held.add(k));
  }
  return [...step];
}

/** Gauss's elimination, of a system scaled to a unit diagonal; what nothing speaks of stays where it is. */
function solve(matrix, right) {
  const n = right.length, scale = matrix.map((row, i) => 1 / Math.sqrt(row[i] || 1));
  const m = matrix.map((row, i) => [...row.map((v, j) => v * scale[i] * scale[j] + (i === j ? 1e-12 : 0)), right[i] * scale[i]]);
  for (let i = 0; i < n; i++) {
    const pivot = m.slice(i).reduce((best, row, j) => (Math.abs(row[i]) > Math.abs(m[best][i]) ? i + j : best), i);
    [m[i], m[pivot]] = [m[pivot], m[i]];
    if (Math.abs(m[i][i]) < 1e-14) continue;
    for (let j = i + 1; j < n; j++) { const f = m[j][i] / m[i][i]; for (let c = i; c <= n; c++) m[j][c] -= f * m[i][c]; }
  }
  const x = new Float64Array(n);
  for (let i = n - 1; i >= 0; i--) {
    let sum = m[i][n];
    for (let j = i + 1; j < n; j++) sum -= m[i][j] * x[j];
    x[i] = Math.abs(m[i][i]) < 1e-14 ? 0 : sum / m[i][i];
  }
  return [...x].map((v, i) => v * scale[i]);
}
