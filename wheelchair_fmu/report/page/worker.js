/* The chair in a worker: simulates runs by WebAssembly and whitens what is left, as loop/likelihood.py does.
 *
 * A page's worker has no imports, so this file stands alone. Messages in:
 *   {load: {models, runs, noise, pushed, tuning, tolerance}}   once; see report/content.py
 *   {job, run, values, exact, brief}        simulate one run with parameter values by name (SI); brief: errors' squares alone
 *   {job, run, values, aside}               the same exactly, without remembering it
 *   {job, run, values, slopes: [[name, step]]}   normal equations of a fit of these parameters
 *   {job, run, values, doubt: {names, covariance}}   how uncertain readings are by values that are
 *   {job, trace}                                              only simulate: a record {values, time, inputs, tolerance, grid}
 * and out: {job, ...result} or {job, error}. Matrices are stored by rows throughout. */
"use strict";

const WHY = {
  1: "the equations gave NaN or infinity",
  2: "no step was short enough for the tolerance, or too many would have been needed",
  3: "the algebraic equations have no solution nearby",
};
const MOST = 64; // states, pushes and readings together, as in innovations.c
const REACH = 3; // standard deviations that a start may be moved

/** One compiled model: a WebAssembly instance whose memory is handed out afresh for every call. */
class Kernel {
  constructor(record) {
    Object.assign(this, record); // effects, parameters, inputs, outputs, states, sensors, columns, starts, delays
    const bytes = Uint8Array.from(atob(record.wasm), (c) => c.charCodeAt(0));
    this.wasm = new WebAssembly.Instance(new WebAssembly.Module(bytes), {}).exports;
    this.base = (this.wasm.wc_page_heap() + 15) & ~15;
    this.reset();
  }

  reset() {
    this.top = this.base;
  }

  /** The address of `count` doubles. */
  doubles(count) {
    const at = this.top;
    this.top += 8 * count;
    const missing = this.top - this.wasm.memory.buffer.byteLength;
    if (missing > 0) this.wasm.memory.grow(Math.ceil(missing / 65536));
    return at;
  }

  /** The address of numbers put into memory. */
  put(numbers) {
    const at = this.doubles(numbers.length);
    new Float64Array(this.wasm.memory.buffer, at, numbers.length).set(numbers);
    return at;
  }

  /** The address of 32-bit words put into memory, with room to a multiple of 8 bytes. */
  words(numbers) {
    const at = this.doubles(Math.ceil(numbers.length / 2));
    new Int32Array(this.wasm.memory.buffer, at, numbers.length).set(numbers);
    return at;
  }

  /** A copy of `count` doubles. */
  get(at, count) {
    return new Float64Array(this.wasm.memory.buffer, at, count).slice();
  }

  /** What a parameter is where nobody sets it. */
  start(name) {
    return this.parameters.find(([n]) => n === name)?.[1] ?? 0;
  }

  vector(values) {
    return Float64Array.from(this.parameters, ([name, start]) => values[name] ?? start);
  }

  /** Inputs (n, nw); a record that is early by `delay` is read that much later. */
  inputRows(time, given, delay) {
    const width = this.inputs.length, rows = new Float64Array(time.length * width);
    this.inputs.forEach(([name, start], column) => {
      let series = given[name];
      if (series && delay) series = interpolated(time, series, delay);
      for (let i = 0; i < time.length; i++) rows[i * width + column] = series ? series[i] : start;
    });
    return rows;
  }

  /** States and results of a run, from the start that the parameters give. */
  run(p, time, rows, tolerance, grid = 0) {
    this.reset();
    const n = time.length;
    const [P, T, W] = [p, time, rows].map((a) => this.put(a));
    const X = this.doubles(n * this.states), Y = this.doubles(n * this.outputs.length), reached = this.doubles(1);
    const status = this.wasm.wc_page_run(P, tolerance, grid, n, T, W, X, Y, reached);
    this.check(status, reached, time);
    return { x: this.get(X, n * this.states), y: this.get(Y, n * this.outputs.length) };
  }

  /** The same with what the filter needs: how states and readings follow from states and pushes before. */
  linearise(p, time, rows, tolerance) {
    this.reset();
    const n = time.length, nx = this.states, ns = this.sensors.length, k = this.columns.length;
    const [P, T, W] = [p, time, rows].map((a) => this.put(a));
    const sizes = {
      transition: (n - 1) * nx * nx, push_before: (n - 1) * nx * campaign.pushed.length, push_after: (n - 1) * nx * campaign.pushed.length,
      by_state: n * ns * nx, by_push: n * ns * campaign.pushed.length, start: nx * k, by_parameter: n * ns * k,
    };
    const at = Object.fromEntries(Object.entries(sizes).map(([name, size]) => [name, this.doubles(size)]));
    const which = this.words(this.columns.map((_, i) => i));
    const out = this.words([k, which, 0, ...Object.values(at)]); // 0: these parameters only move the start
    const X = this.doubles(n * nx), Y = this.doubles(n * this.outputs.length), reached = this.doubles(1);
    const work = this.doubles(this.wasm.wc_page_work(k));
    const status = this.wasm.wc_page_linearise(P, tolerance, n, T, W, X, Y, out, work, reached);
    this.check(status, reached, time);
    const got = Object.fromEntries(Object.entries(sizes).map(([name, size]) => [name, this.get(at[name], size)]));
    return { ...got, x: this.get(X, n * nx), y: this.get(Y, n * this.outputs.length) };
  }

  check(status, reached, time) {
    if (!status) return;
    const row = new Int32Array(this.wasm.memory.buffer, reached, 1)[0];
    const when = time[Math.min(Math.max(row, 1), time.length) - 1];
    throw new Error(`the simulation stops at t = ${when.toPrecision(6)} s: ${WHY[status]}`);
  }

  /** Calls `act` with the addresses of a filter's record, whose matrices are put into memory, and of its `present`. */
  withFilter(filter, startCov, act) {
    this.reset();
    const { system, noise, present, nz } = filter, nx = this.states, nq = campaign.pushed.length;
    if (nx + nq + nz > MOST) throw new Error(`${nx} states, ${nq} pushes and ${nz} readings are more than ${MOST}`);
    const arrays = [system.A, system.B, system.C, system.H, system.D, noise.push_sd, noise.push_ar, noise.sd, noise.ar, startCov];
    const flags = this.doubles(Math.ceil(present.length / 8));
    new Uint8Array(this.wasm.memory.buffer, flags, present.length).set(present);
    return act(this.words([nx, nq, nz, ...arrays.map((a) => this.put(a)), flags, 0]), flags); // 0: the pushes' noises are each on their own
  }
}

/** The filter of one linearised run, as engine/innovations.py's Whitener. */
class Whitener {
  constructor(kernel, system, noise, present, n, startCov, dt) {
    Object.assign(this, { kernel, system, noise, present, n, startCov, nz: noise.sd.length });
    this.size = kernel.states + campaign.pushed.length + this.nz;
    kernel.withFilter(this, startCov, (record, flags) => {
      kernel.wasm.wc_page_drop_kinks(record, n, dt);
      this.present = new Uint8Array(kernel.wasm.memory.buffer, flags, present.length).slice();
      const gain = kernel.doubles(n * this.nz * this.size), scale = kernel.doubles(n * this.nz);
      kernel.wasm.wc_page_design(record, n, gain, scale);
      this.gain = kernel.get(gain, n * this.nz * this.size);
      this.scale = kernel.get(scale, n * this.nz);
    });
  }

  /** Innovations of signals (n, nz, m), in place; 0 in gaps and kinks. `startMean` belongs to the first signal. */
  whiten(signals, m, startMean) {
    const { kernel, n } = this;
    kernel.withFilter(this, this.startCov, (record) => {
      const [gain, scale, mean, at] = [this.gain, this.scale, startMean, signals].map((a) => kernel.put(a));
      kernel.wasm.wc_page_whiten(record, n, gain, scale, mean, m, at, kernel.doubles(2 * this.size * m));
      signals.set(new Float64Array(kernel.wasm.memory.buffer, at, signals.length));
    });
    return signals;
  }

  /** One over the standard deviation of each reading (n, nz): its sensor's noise, and push noise added up by the chair. */
  spread() {
    const { kernel, n, nz } = this;
    return kernel.withFilter(this, new Float64Array(kernel.states ** 2), (record) => {
      const scale = kernel.doubles(n * nz);
      kernel.wasm.wc_page_spread(record, n, scale);
      return kernel.get(scale, n * nz);
    });
  }
}

/** Median of the time between samples. */
function usualStep(time) {
  const steps = Float64Array.from(time.slice(1), (t, i) => t - time[i]).sort(), half = steps.length >> 1;
  return steps.length % 2 ? steps[half] : (steps[half - 1] + steps[half]) / 2;
}

/** The same between the samples of a channel that has gaps. */
function ownStep(time, series) {
  const own = time.filter((_, i) => !Number.isNaN(series[i]));
  return usualStep(own.length > 1 ? own : time);
}

/** AR(1) coefficients (n - 1, m) over each interval, from those over each series' own step, as engine/innovations.py. */
function byInterval(time, coefficients, steps) {
  const m = coefficients.length, out = new Float64Array((time.length - 1) * m);
  for (let i = 0; i + 1 < time.length; i++)
    for (let c = 0; c < m; c++) out[i * m + c] = coefficients[c] > 0 ? coefficients[c] ** ((time[i + 1] - time[i]) / steps[c]) : 0;
  return out;
}

/** Standard deviations (n, nq) of the recorded pushes and their coefficients (n - 1, nq), as engine/innovations.py. */
function noiseOfPushes(time) {
  const n = time.length, nq = campaign.pushed.length, own = usualStep(time), gap = (i) => time[i + 1] - time[i];
  const ar = campaign.pushed.map((c) => campaign.noise.ar[c] ?? 0), push_sd = new Float64Array(n * nq);
  for (let i = 0; i < n; i++) {
    const around = i === 0 ? gap(0) : i === n - 1 ? gap(n - 2) : (gap(i - 1) + gap(i)) / 2;
    campaign.pushed.forEach((c, q) => {
      const there = ar[q] ** (around / own), lasting = (own * (1 + ar[q])) / (1 - ar[q]);
      push_sd[i * nq + q] = (campaign.noise.sd[c] ?? 0) * Math.sqrt(lasting / ((around * (1 + there)) / (1 - there)));
    });
  }
  return { push_sd, push_ar: byInterval(time, ar, campaign.pushed.map(() => own)) };
}

function interpolated(time, series, delay) {
  const out = new Float64Array(time.length);
  for (let i = 0, j = 0; i < time.length; i++) {
    const t = time[i] - delay;
    if (t <= time[0]) { out[i] = series[0]; j = 0; continue; }
    if (t >= time.at(-1)) { out[i] = series.at(-1); continue; }
    while (j > 0 && time[j] > t) j--;
    while (time[j + 1] < t) j++;
    out[i] = series[j] + ((series[j + 1] - series[j]) / (time[j + 1] - time[j])) * (t - time[j]);
  }
  return out;
}

/** The columns `wanted` of each of n rows of a matrix (n, rows, columns), and of its rows those in `which`. */
function part(matrix, n, rows, columns, which, wanted) {
  const out = new Float64Array(n * which.length * wanted);
  let to = 0;
  for (let i = 0; i < n; i++)
    for (const r of which)
      for (let c = 0; c < wanted; c++) out[to++] = matrix[(i * rows + r) * columns + c];
  return out;
}

let campaign, kernels;
const remembered = []; // by run: what the last exact evaluation found, good to first order nearby

function load(given) {
  campaign = given;
  kernels = given.models.map((record) => new Kernel(record));
}

/** The lightest model that has every effect of these values. */
function kernelFor(values) {
  const on = Object.keys(values).filter((n) => n.startsWith("effect.") && values[n] !== 0).map((n) => n.split(".")[1]);
  const kernel = kernels.find((k) => on.every((effect) => k.effects.includes(effect)));
  if (!kernel) throw new Error(`no model in this page has ${on.join(", ")} together`);
  return kernel;
}

/** One run with one kernel: what was measured, less the sensors' offsets, what its noise is, and where its readings are. */
function frame(kernel, index, values) {
  const run = campaign.runs[index], names = Object.keys(run.channels), nz = names.length, n = run.time.length;
  const which = names.map((c) => kernel.sensors.indexOf(campaign.outputs[c]));
  const place = which.map((s) => kernel.outputs.indexOf(kernel.sensors[s]));
  const measured = new Float64Array(n * nz), offsets = names.map((name) => values[`offset.${name}`] ?? 0);
  names.forEach((name, z) => { for (let i = 0; i < n; i++) measured[i * nz + z] = run.channels[name][i] - offsets[z]; });
  const coefficients = names.map((c) => campaign.noise.ar[c] ?? 0), steps = names.map((c) => ownStep(run.time, run.channels[c]));
  const noise = {
    ...noiseOfPushes(run.time),
    sd: Float64Array.from(names, (c) => campaign.noise.sd[c]),
    ar: byInterval(run.time, coefficients, steps),
  };
  const present = Uint8Array.from(measured, (v) => (Number.isNaN(v) ? 0 : 1));
  return { kernel, run, names, nz, n, which, place, measured, noise, present, offsets };
}

/** Parameters and inputs of a run; what the run itself sets stands. */
function given({ kernel, run }, values, start) {
  const all = { ...campaign.known, ...values, ...run.set, ...start };
  const delay = kernel.delays.reduce((sum, name) => sum + (all[name] ?? 0), 0);
  return [kernel.vector(all), run.time, kernel.inputRows(run.time, run.inputs, delay)];
}

function readings({ kernel, n, nz, place }, y) {
  const out = new Float64Array(n * nz), width = kernel.outputs.length;
  for (let i = 0; i < n; i++) for (let z = 0; z < nz; z++) out[i * nz + z] = y[i * width + place[z]];
  return out;
}

/** Simulate from a start, linearise, and make the filter: {start, y, predicted, byStart, offset, whitener}. */
function linearised(f, values, start) {
  const { kernel, run, n, nz, which } = f, nx = kernel.states, starts = kernel.starts, k = starts.length, ns = kernel.sensors.length;
  const s = kernel.linearise(...given(f, values, start), campaign.tolerance);
  const every = [...Array(nx).keys()], nq = campaign.pushed.length;
  const system = {
    A: s.transition,
    B: part(s.push_before, n - 1, nx, campaign.pushed.length, every, nq),
    C: part(s.push_after, n - 1, nx, campaign.pushed.length, every, nq),
    H: part(s.by_state, n, ns, nx, which, nx),
    D: part(s.by_push, n, ns, campaign.pushed.length, which, nq),
  };
  const column = starts.map((name) => kernel.columns.indexOf(name)), sd = starts.map((name) => run.start_sd[name]);
  const byStart = new Float64Array(n * nz * k), cov = new Float64Array(nx * nx), offset = new Float64Array(nx);
  for (let c = 0; c < k; c++) {
    const off = run.start[starts[c]] - start[starts[c]];
    for (let r = 0; r < nx; r++) {
      const a = s.start[r * k + column[c]];
      offset[r] += a * off;
      for (let q = 0; q < nx; q++) cov[r * nx + q] += a * sd[c] * sd[c] * s.start[q * k + column[c]];
    }
    if (starts[c] in run.set) continue; // a run's own setting stands, so that parameter moves nothing in it
    for (let i = 0; i < n; i++) for (let z = 0; z < nz; z++) byStart[(i * nz + z) * k + c] = s.by_parameter[(i * ns + which[z]) * k + column[c]];
  }
  const whitener = new Whitener(kernel, system, f.noise, f.present, n, cov, usualStep(run.time));
  return { start, y: s.y, predicted: readings(f, s.y), byStart, offset, whitener };
}

/** What each reading says that was not known from those before it, where the chair reads `predicted` from the start of `s`. */
function innovations(f, s, predicted) {
  return s.whitener.whiten(f.measured.map((v, i) => v - predicted[i]), 1, s.offset);
}

/** How each innovation goes with the start (n, nz, k). */
function startSlopes(f, s) {
  return s.whitener.whiten(s.byStart.slice(), f.kernel.starts.length, new Float64Array(f.kernel.states));
}

/** The start given all readings, to first order: prior mean + P0 S0' r, of innovations r and how they go with the start. */
function betterStart({ kernel, run }, r, slopes) {
  const k = kernel.starts.length, found = {};
  kernel.starts.forEach((name, c) => {
    let sum = 0;
    for (let i = 0; i < r.length; i++) sum += r[i] * slopes[i * k + c];
    const sd = run.start_sd[name], step = sd * sd * sum;
    found[name] = run.start[name] + Math.min(Math.max(step, -REACH * sd), REACH * sd);
  });
  return found;
}

/** Where a run is expected to start before its readings are asked, by parameters that the model has: not every one has casters
 *  that swing. */
const expectedStart = ({ kernel, run }) => Object.fromEntries(kernel.starts.map((name) => [name, run.start[name]]));

/** As `wheelchair compare` does it: the start is moved to where the readings want it, until it is there. */
function exactly(f, values) {
  let start = expectedStart(f), s = whitened(f, values, start);
  for (let round = 0; round < campaign.tuning; round++) {
    const better = betterStart(f, s.innovations, s.slopes);
    if (f.kernel.starts.every((name) => Math.abs(better[name] - start[name]) <= campaign.settled * f.run.start_sd[name])) break;
    start = better;
    s = whitened(f, values, start);
  }
  return { ...s, spread: s.whitener.spread() };
}

/** The same as `linearised`, with innovations and how they go with the start. */
function whitened(f, values, start) {
  const s = linearised(f, values, start);
  return { ...s, innovations: innovations(f, s, s.predicted), slopes: startSlopes(f, s) };
}

/** Simulated anew, with the filter of the last exact evaluation; a better start moves the readings to first order. */
function nearby(f, values, last) {
  const { y } = f.kernel.run(...given(f, values, last.start), campaign.tolerance), predicted = readings(f, y);
  const r = innovations(f, last, predicted); // to first order the same wherever the simulation starts
  const start = betterStart(f, r, last.slopes), k = f.kernel.starts.length;
  f.kernel.starts.forEach((name, c) => {
    const step = start[name] - last.start[name];
    for (let i = 0; i < predicted.length; i++) predicted[i] += step * last.byStart[i * k + c];
  });
  return { start, y, predicted, spread: last.spread, innovations: r };
}

function evaluate(index, values, exact, aside) {
  const kernel = kernelFor(values), f = frame(kernel, index, values), last = remembered[index];
  if (aside) return summary(f, exactly(f, values));
  if (!exact && last?.whitener.kernel === kernel) return summary(f, nearby(f, values, last));
  remembered[index] = exactly(f, values);
  return summary(f, remembered[index]);
}

/** What one run says of a fit: innovations r and how they go with each of `steps` [[name, step]], as {jtj, jtr, squares}.
 *  The filter is that of the values themselves, as in loop/fit.py. */
function slopes(index, values, steps) {
  const kernel = kernelFor({ ...values, ...Object.fromEntries(steps.map(([name]) => [name, values[name] || 1])) }), f = frame(kernel, index, values);
  const s = linearised(f, values, expectedStart(f)), r = innovations(f, s, s.predicted), k = steps.length;
  const moved = steps.map(([name, step]) => {
    const there = frame(kernel, index, { ...values, [name]: (values[name] ?? campaign.known[name] ?? kernel.start(name)) + step });
    const { y } = kernel.run(...given(there, { ...values, [name]: (values[name] ?? campaign.known[name] ?? kernel.start(name)) + step }, s.start), campaign.tolerance);
    return innovations(there, s, readings(there, y)).map((v, i) => (v - r[i]) / step);
  });
  const jtj = new Float64Array(k * k), jtr = new Float64Array(k);
  let squares = 0;
  for (let i = 0; i < r.length; i++) {
    if (!Number.isFinite(r[i])) continue;
    squares += r[i] * r[i];
    for (let a = 0; a < k; a++) {
      jtr[a] += moved[a][i] * r[i];
      for (let b = 0; b <= a; b++) jtj[a * k + b] += moved[a][i] * moved[b][i];
    }
  }
  for (let a = 0; a < k; a++) for (let b = a + 1; b < k; b++) jtj[a * k + b] = jtj[b * k + a];
  return { jtj, jtr, squares };
}

/** Variances that readings have by channel because values have these covariances (k, k): to first order, from a start that
 *  follows the values as far as readings have it. */
function doubted(index, values, { names, covariance }) {
  const kernel = kernelFor(values), f = frame(kernel, index, values), last = exactly(f, values), k = names.length;
  const moved = names.map((name, a) => {
    const step = Math.sqrt(covariance[a][a]), there = { ...values, [name]: (values[name] ?? campaign.known[name] ?? kernel.start(name)) + step };
    const g = frame(kernel, index, there), { predicted } = nearby(g, there, last);
    return predicted.map((v, i) => (v + g.offsets[i % f.nz] - last.predicted[i] - f.offsets[i % f.nz]) / step);
  });
  const variance = {};
  f.names.forEach((name, z) => {
    const series = (variance[name] = new Float64Array(f.n));
    for (let i = 0; i < f.n; i++) {
      const at = i * f.nz + z;
      for (let a = 0; a < k; a++) for (let b = 0; b < k; b++) series[i] += moved[a][at] * covariance[a][b] * moved[b][at];
    }
  });
  return { variance };
}

/** Errors by channel, as loop/likelihood.py's `errors`, their squares and those in SI units (`gaps`), and the series that the
 *  page draws: readings, and standard deviations of what is measured about them where values are right. */
function summary({ kernel, names, n, nz, measured, offsets }, { start, y, predicted, spread, innovations }) {
  const errors = {}, simulated = {}, deviations = {}, squares = {}, counts = {}, gaps = {};
  names.forEach((name, z) => {
    const e = new Float64Array(n), p = new Float64Array(n), sd = new Float64Array(n), offset = offsets[z], drifts = campaign.drifting.includes(name);
    let sum = 0, count = 0, apart = 0;
    for (let i = 0; i < n; i++) {
      const d = measured[i * nz + z] - predicted[i * nz + z]; // NaN in gaps
      e[i] = !drifts || Number.isNaN(d) ? d * spread[i * nz + z] : innovations[i * nz + z];
      p[i] = predicted[i * nz + z] + offset; // as the sensor reads it
      sd[i] = 1 / spread[i * nz + z];
      if (!Number.isNaN(e[i])) { sum += e[i] * e[i]; apart += d * d; count++; }
    }
    [errors[name], simulated[name], deviations[name], squares[name], counts[name], gaps[name]] = [e, p, sd, sum, count, apart];
  });
  const results = {}, width = kernel.outputs.length;
  for (const name of campaign.shown) {
    const at = kernel.outputs.indexOf(name), series = (results[name] = new Float64Array(n));
    for (let i = 0; i < n; i++) series[i] = y[i * width + at];
  }
  return { errors, predicted: simulated, sd: deviations, squares, counts, gaps, results, start };
}

/** A bare simulation, for comparing this page with another program. */
function trace({ values, time, inputs, tolerance, grid }) {
  const kernel = kernelFor(values), p = kernel.vector({ ...campaign.known, ...values });
  const { y } = kernel.run(p, time, kernel.inputRows(time, inputs, 0), tolerance, grid);
  return { outputs: kernel.outputs, y };
}

/** The same without series. */
const briefly = ({ squares, counts, gaps, start }) => ({ squares, counts, gaps, start, brief: true });

function answer({ load: all, job, run, values, exact, brief, aside, slopes: steps, doubt, trace: wanted }) {
  if (all) return load(all);
  const began = performance.now();
  try {
    const result = wanted ? trace(wanted) : steps ? slopes(run, values, steps) : doubt ? doubted(run, values, doubt) : evaluate(run, values, exact, aside);
    return { job, run, ...(brief ? briefly(result) : result), ms: performance.now() - began };
  } catch (error) {
    return { job, run, error: error.message };
  }
}

/** Series go to the page without being copied: nothing here needs them again. */
const buffers = ({ errors, predicted, sd, results, variance }) => [errors, predicted, sd, results, variance].filter(Boolean).flatMap((all) => Object.values(all).map((a) => a.buffer));

self.onmessage = ({ data }) => {
  const reply = answer(data);
  if (reply) self.postMessage(reply, buffers(reply));
};
