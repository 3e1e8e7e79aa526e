/* The chair in a worker: what comes as a message goes to the module that evaluates runs, engine/csrc/evaluation.c, and back.
 *
 * A page's worker has no imports, so this file stands alone. Messages in:
 *   {load: {models, runs, known, forces, …}}   once; see report/content.py
 *   {job, run, values, exact, brief}        simulate one run with parameter values by name (SI); brief: errors' squares alone
 *   {job, several: [{run, brief}], values, exact}   the same of several: a reply with `more` for each in full, and {job, briefs}
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
  4: "it has more states, pushes and readings than there is room for",
  5: "what a clock or a baseline would do grows beyond all numbers",
};
const KINDS = { clock: 0, baseline: 1 }; // as wc_constant in evaluation.h
const SPEEDS = [3, 4]; // places of u and v: the states of every model begin with x, y, psi, u, v

const ROOM = 64; // pages of memory that are needed at once: a model's own, and behind it those of what evaluates its runs
const WHERE = { start: 0, results: 1, r: 4, path: 5 }; // in a wc_simulated, and in an evaluation, which begins with one

let campaign, kernels;

const module = (text) => new WebAssembly.Module(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));

/** One compiled model, and what evaluates its runs in its memory, in which these and what was found about them are kept. */
class Kernel {
  constructor(record, evaluation) {
    Object.assign(this, record); // effects, parameters, inputs, outputs, states, sensors, columns, starts, flips, delays
    const model = new WebAssembly.Instance(module(record.wasm), {}).exports;
    model.memory.grow(ROOM);
    this.wasm = { ...model, ...new WebAssembly.Instance(evaluation, { model, env: { memory: model.memory } }).exports, memory: model.memory };
    this.top = (this.wasm.wc_page_free() + 15) & ~15;
    this.of = [this.wasm.wc_page_kernel(), this.wasm.wc_page_tangent()];
    this.recordings = [];
    this.blocks = {};
  }

  /** The address of `count` doubles, for good. */
  doubles(count) {
    const at = this.top;
    this.top += 8 * count;
    const missing = this.top - this.wasm.memory.buffer.byteLength;
    if (missing > 0) this.wasm.memory.grow(Math.ceil(missing / 65536));
    return at;
  }

  /** The address of as many, where `name` says what for: what was there before is lost where it has to be larger. */
  block(name, count) {
    if (!(this.blocks[name]?.count >= count)) this.blocks[name] = { count, at: this.doubles(count) };
    return this.blocks[name].at;
  }

  /** The address of numbers put into memory: for good, or where `name` says. */
  put(numbers, name) {
    const at = name ? this.block(name, numbers.length) : this.doubles(numbers.length);
    new Float64Array(this.wasm.memory.buffer, at, numbers.length).set(numbers);
    return at;
  }

  /** The address of 32-bit words put into memory, with room to a multiple of 8 bytes. */
  words(numbers, name) {
    const count = Math.ceil(numbers.length / 2), at = name ? this.block(name, count) : this.doubles(count);
    new Int32Array(this.wasm.memory.buffer, at, numbers.length).set(numbers);
    return at;
  }

  /** A copy of `count` doubles. */
  get(at, count) {
    return new Float64Array(this.wasm.memory.buffer, at, count).slice();
  }

  /** Copies of the columns of a matrix, by number: (z) => (count,). Good until memory grows. */
  split(at, count, width) {
    const all = new Float64Array(this.wasm.memory.buffer, at, count * width);
    return (z) => {
      const out = new Float64Array(count);
      for (let i = 0, k = z; i < count; i++, k += width) out[i] = all[k];
      return out;
    };
  }

  /** The address that stands in a record. */
  pointer(record, place) {
    return new Int32Array(this.wasm.memory.buffer, record, place + 1)[place];
  }

  /** What a parameter is where nobody sets it. */
  start(name) {
    return this.parameters.find(([n]) => n === name)?.[1] ?? 0;
  }

  vector(values) {
    return Float64Array.from(this.parameters, ([name, start]) => values[name] ?? start);
  }

  /** Inputs (n, nw) as recorded. */
  inputRows(time, given) {
    const width = this.inputs.length, rows = new Float64Array(time.length * width);
    this.inputs.forEach(([name, start], column) => {
      const series = given[name];
      for (let i = 0; i < time.length; i++) rows[i * width + column] = series ? series[i] : start;
    });
    return rows;
  }

  check(status, reached, time) {
    if (!status) return;
    const when = time[Math.min(Math.max(reached, 1), time.length) - 1];
    throw new Error(`the simulation stops at t = ${when.toPrecision(6)} s: ${WHY[status]}`);
  }

  /** A run's recording, as evaluation.h has it: made once. */
  recording(index) {
    return (this.recordings[index] ??= this.recorded(campaign.runs[index]));
  }

  recorded(run) {
    const { wasm } = this, names = Object.keys(run.channels), nz = names.length, n = run.time.length, inputs = this.inputs.map(([name]) => name);
    const flags = (all, some) => all.map((name) => +some.includes(name)), among = (all) => (name) => all.indexOf(name);
    const series = names.map((c) => run.channels[c]), time = this.put(run.time), { pushes, constants } = run, nq = pushes.names.length;
    const forces = campaign.forces ?? { sd: [], body: [], places: [], recorded: [], lasting: [], together: [], as_push: {}, as_reading: {} }, nd = forces.lasting.length;
    const [asPush, asReading] = [[pushes.names, forces.as_push], [names, forces.as_reading]].map(([all, by]) => all.flatMap((name) => by[name] ?? forces.lasting.map(() => 0)));
    const each = (of, changed, times) => Float64Array.from({ length: n * nd }, (_, at) => of[at % nd] * (changed[at % nd] ? times(Math.floor(at / nd)) : 1));
    const acting = forces.sd.map((sd, d) => (forces.recorded[d] && !pushes.names.includes("rider.momentum") ? 0 : sd));
    const sizes = each(acting, forces.body, (i) => run.swinging[i]), lasting = each(forces.lasting, forces.places, (i) => 1 / run.pace[i]);
    const recorded = Float64Array.from({ length: n * nz }, (_, at) => series[at % nz][Math.floor(at / nz)]);
    const doubles = (list) => this.put(Float64Array.from(list)), ints = (list) => this.words(list);
    const of = (part) => constants.flatMap(part), shape = of((c) => [...(c.shape ?? new Float64Array(n))]);
    const record = this.words([
      ...this.of, n, time, this.put(this.inputRows(run.time, run.inputs)), this.put(recorded), ints(flags(inputs, inputs.filter((i) => !campaign.body.includes(i)))),
      ints(flags(names, campaign.drifting)), doubles([run.usual]), ...SPEEDS,
      nq, nz, nd, time, ints(pushes.names.map(among(inputs))), ints(names.map((c) => this.sensors.indexOf(campaign.outputs[c]))),
      doubles(pushes.sd), doubles(pushes.ar), doubles(pushes.step), doubles(run.noise.sd), doubles(run.noise.ar), doubles(run.noise.step),
      this.put(sizes), this.put(lasting), doubles(forces.together.flat()), doubles(asPush), doubles(asReading),
      this.starts.length, 0, ints(this.starts.map(among(this.columns))), this.starts.length, ints(this.starts.map(among(this.parameters.map(([name]) => name)))),
      ints(this.starts.map((name) => +(name in run.set))), this.starts.indexOf("start.u"), doubles(this.starts.map((s) => run.start[s])), doubles(this.starts.map((s) => run.start_sd[s])),
      constants.length, ints(of((c) => KINDS[c.kind])), ints(of((c) => flags(inputs, c.inputs))), ints(of((c) => flags(names, c.channels))), doubles(shape), doubles(of((c) => c.sd)),
      +campaign.leads,
    ]);
    const rooms = this.block("rooms", 1), scratch = this.block("record", wasm.wc_page_record());
    wasm.wc_page_room(record, scratch, 0, 0, rooms, 0);
    const [kept, work] = new Int32Array(wasm.memory.buffer, rooms, 2);
    return { run, record, names, n, nz, uncertain: this.starts.length + constants.length, kept, work, again: wasm.wc_page_again_room(record, scratch, 0), pushes: n * nq, trials: wasm.wc_page_pushes_room(record), evaluation: null };
  }

  /** A place for an evaluation of a recording: its own, which is remembered, or one for all that are not. */
  place(of, own) {
    if (own) of.evaluation ??= { record: this.doubles(this.wasm.wc_page_record()), kept: this.doubles(of.kept), errors: this.flips ? this.doubles(of.pushes) : 0, pushed: 0, whole: false };
    const there = own ? of.evaluation : { record: this.block("aside record", this.wasm.wc_page_record()), kept: this.block("aside", of.kept), errors: this.flips ? this.block("aside errors", of.pushes) : 0, pushed: 0 };
    this.lay(of, there);
    return there;
  }

  /** Start and path of an evaluation, and the errors of its pushes, for another to begin with. */
  follow(of, one, other) {
    this.lay(of, one);
    const forces = (campaign.forces?.lasting.length ?? 0) * of.n, memory = () => new Float64Array(this.wasm.memory.buffer);
    for (const [place, count] of [[WHERE.start, of.uncertain], [WHERE.path, forces]]) {
      const from = this.pointer(one.record, place), to = this.pointer(other.record, place);
      memory().copyWithin(to / 8, from / 8, from / 8 + count);
    }
    if (!one.pushed) return;
    memory().copyWithin(other.errors / 8, one.errors / 8, one.errors / 8 + of.pushes);
    other.pushed = other.errors;
    this.lay(of, other);
  }

  lay(of, { record, kept, pushed }) {
    this.wasm.wc_page_room(of.record, record, kept, this.block("work", of.work), this.block("rooms", 1), pushed);
  }
}

/** The lightest model that has every effect of these values. */
function kernelFor(values) {
  const on = Object.keys(values).filter((n) => n.startsWith("effect.") && values[n] !== 0).map((n) => n.split(".")[1]);
  const kernel = kernels.find((k) => on.every((effect) => k.effects.includes(effect)));
  if (!kernel) throw new Error(`no model in this page has ${on.join(", ")} together`);
  return kernel;
}

/** Values of a model as evaluation.h has them; what the run itself sets stands, but for the mass that forces are felt by. */
function given(kernel, { run, names }, values, name = "values") {
  const chair = { ...campaign.known, ...values }, all = { ...chair, ...run.set }, mass = chair["chair.m"] ?? kernel.start("chair.m");
  const delay = kernel.delays.reduce((sum, d) => sum + (all[d] ?? 0), 0), along = campaign.noise.mass ? mass / campaign.noise.mass : 1;
  const numbers = [campaign.tolerance, delay, along, mass];
  const [p, offsets, others] = [kernel.vector(all), names.map((c) => values[`offset.${c}`] ?? 0), numbers].map((a, i) => kernel.put(a, `${name} ${i}`));
  return kernel.words([p, offsets, others], name);
}

/** An evaluation in `place`, from where the run is expected to start; one that is led, from where it was led before, and slopes
 *  about the errors of pushes that were found before, which are looked for where it is to be exact. */
function evaluated(kernel, of, values, place, { rounds = campaign.tuning, exact = true } = {}) {
  const { wasm } = kernel, follows = campaign.leads || (kernel.flips && !rounds), known = follows && of.evaluation?.whole;
  const set = given(kernel, of, values), work = kernel.flips ? kernel.block("trials", of.trials) : 0;
  if (known && place !== of.evaluation) kernel.follow(of, of.evaluation, place);
  place.whole = false;
  const status = wasm.wc_page_evaluate(of.record, set, place.record, +!known, follows && !known ? campaign.tuning : rounds, exact ? place.errors : 0, work);
  place.pushed = wasm.wc_page_pushed(place.record);
  kernel.check(status, wasm.wc_page_reached(place.record), of.run.time);
  place.whole = true;
  place.values = values;
  return place;
}

/** The run at other values by the filter of an evaluation. */
function again(kernel, of, values, place, kept = false) {
  const { wasm } = kernel, to = kernel.block("again record", 8), set = given(kernel, of, values, "other values");
  wasm.wc_page_again_room(of.record, to, kernel.block("again", of.again));
  kernel.check(wasm.wc_page_again(of.record, set, place.record, +kept, to), wasm.wc_page_reached(place.record), of.run.time);
  return { to, set };
}

/** What the page shows: errors by channel, their squares and those in SI units (`gaps`), which `model` of the page's ran, its
 *  readings, and standard deviations of what is measured about them where values are right; in `brief` without series. */
function told(kernel, of, place, simulated, set, brief) {
  const { wasm } = kernel, { n, nz, names } = of, [shown, sd, errors] = ["shown", "sd", "errors"].map((name) => kernel.block(name, n * nz)), sums = kernel.block("sums", 3 * nz);
  wasm.wc_page_tell(of.record, set, place.record, simulated, shown, sd, errors, sums);
  const by = (make) => Object.fromEntries(names.map((name, z) => [name, make(z)])), total = kernel.get(sums, 3 * nz), start = kernel.get(kernel.pointer(simulated, WHERE.start), of.uncertain);
  const summed = {
    squares: by((z) => total[3 * z]), counts: by((z) => total[3 * z + 1]), gaps: by((z) => total[3 * z + 2]),
    start: Object.fromEntries(kernel.starts.map((name, c) => [name, start[c]])),
  };
  if (brief) return { ...summed, brief };
  const results = kernel.split(kernel.pointer(simulated, WHERE.results), n, kernel.outputs.length);
  return {
    ...summed, model: kernels.indexOf(kernel), errors: by(kernel.split(errors, n, nz)), predicted: by(kernel.split(shown, n, nz)), sd: by(kernel.split(sd, n, nz)),
    results: Object.fromEntries(campaign.shown.map((name) => [name, results(kernel.outputs.indexOf(name))])),
  };
}

function evaluate(index, values, { exact, aside, brief }) {
  const kernel = kernelFor(values), of = kernel.recording(index), place = kernel.place(of, !aside);
  if (!aside && !exact && place.whole && remembered[index] === kernel) {
    const { to, set } = again(kernel, of, values, place);
    return told(kernel, of, place, to, set, brief);
  }
  if (!aside) remembered[index] = kernel;
  evaluated(kernel, of, values, place, { exact: Boolean(exact || aside) });
  return told(kernel, of, place, place.record, given(kernel, of, values), brief);
}

/** What was found at these values already, or is found now. */
function found(kernel, of, values) {
  const own = of.evaluation;
  if (!own?.whole || JSON.stringify(own.values) !== JSON.stringify(values)) return evaluated(kernel, of, values, kernel.place(of, false));
  kernel.lay(of, own);
  return own;
}

/** Simulations where each of some values is a step larger, by `take`. */
function moved(kernel, of, values, place, steps, kept, take) {
  const { n, nz } = of, all = kernel.block("moved", steps.length * n * nz);
  steps.forEach(([name, step], a) => {
    const now = values[name] ?? campaign.known[name] ?? kernel.start(name), other = again(kernel, of, { ...values, [name]: now + step }, place, kept);
    new Float64Array(kernel.wasm.memory.buffer, all + 8 * a * n * nz, n * nz).set(take(other));
  });
  return all;
}

/** What one run says of a fit: innovations r and how they go with each of `steps` [[name, step]], as {jtj, jtr, squares}.
 *  The filter is that of the values themselves, as in inference/estimation/fit.py. */
function slopes(index, values, steps) {
  const kernel = kernelFor({ ...values, ...Object.fromEntries(steps.map(([name]) => [name, values[name] || 1])) }), of = kernel.recording(index), { wasm } = kernel, k = steps.length;
  const place = evaluated(kernel, of, values, kernel.place(of, false), { rounds: 0 });
  const all = moved(kernel, of, values, place, steps, true, ({ to }) => kernel.get(kernel.pointer(to, WHERE.r), of.n * of.nz));
  const [jtj, jtr, squares] = [k * k, k, 1].map((count, i) => kernel.block(`normal ${i}`, count));
  wasm.wc_page_normal(of.record, place.record, k, kernel.put(Float64Array.from(steps, ([, step]) => step), "steps"), all, jtj, jtr, squares);
  return { jtj: kernel.get(jtj, k * k), jtr: kernel.get(jtr, k), squares: kernel.get(squares, 1)[0] };
}

/** Variances that readings have by channel because values have these covariances (k, k): to first order, from a start that
 *  follows the values as far as readings have it. */
function doubted(index, values, { names, covariance }) {
  const kernel = kernelFor(values), of = kernel.recording(index), { wasm } = kernel, { n, nz } = of;
  const steps = names.map((name, a) => [name, Math.sqrt(covariance[a][a])]), place = found(kernel, of, values);
  const [base, shown, variance] = ["base", "shown", "variance"].map((name) => kernel.block(name, n * nz));
  wasm.wc_page_as_read(of.record, given(kernel, of, values), place.record, base);
  const all = moved(kernel, of, values, place, steps, false, ({ to, set }) => { wasm.wc_page_as_read(of.record, set, to, shown); return kernel.get(shown, n * nz); });
  const [sizes, spread] = [Float64Array.from(steps, ([, step]) => step), Float64Array.from(covariance.flat())].map((a, i) => kernel.put(a, `doubt ${i}`));
  wasm.wc_page_doubt(of.record, names.length, base, sizes, all, spread, variance);
  const column = kernel.split(variance, n, nz);
  return { variance: Object.fromEntries(of.names.map((name, z) => [name, column(z)])) };
}

/** A bare simulation, for comparing this page with another program. */
function trace({ values, time, inputs, tolerance, grid }) {
  const kernel = kernelFor(values), n = time.length, { wasm } = kernel;
  const [P, T, W] = [kernel.vector({ ...campaign.known, ...values }), time, kernel.inputRows(time, inputs)].map((a, i) => kernel.put(a, `trace ${i}`));
  const [X, Y, reached] = [n * kernel.states, n * kernel.outputs.length, 1].map((count, i) => kernel.block(`traced ${i}`, count));
  const status = wasm.wc_page_run(P, tolerance, grid, n, T, W, X, Y, reached);
  kernel.check(status, kernel.pointer(reached, 0), time);
  return { outputs: kernel.outputs, y: kernel.get(Y, n * kernel.outputs.length) };
}

const remembered = []; // by run: the model whose last exact evaluation is good to first order nearby

function load(given) {
  campaign = given;
  const evaluation = module(given.evaluation);
  kernels = given.models.map((record) => new Kernel(record, evaluation));
}

function answer({ load: all, job, run, values, exact, brief, aside, slopes: steps, doubt, trace: wanted }) {
  if (all) return load(all);
  const began = performance.now();
  try {
    const result = wanted ? trace(wanted) : steps ? slopes(run, values, steps) : doubt ? doubted(run, values, doubt) : evaluate(run, values, { exact, aside, brief });
    return { job, run, ...result, ms: performance.now() - began };
  } catch (error) {
    return { job, run, error: error.message };
  }
}

/** Series go to the page without being copied: nothing here needs them again. */
const buffers = ({ errors, predicted, sd, results, variance }) => [errors, predicted, sd, results, variance].filter(Boolean).flatMap((all) => Object.values(all).map((a) => a.buffer));

function send(reply) {
  self.postMessage(reply, buffers(reply));
}

/** Several runs with the same values: those whose series are wanted one by one, all others in one message, the last, as every
 *  message keeps the page's thread from drawing. */
function answerAll({ job, several, values, exact }) {
  const briefs = [];
  for (const { run, brief } of several) {
    const reply = answer({ job, run, values, exact, brief });
    if (brief) briefs.push(reply);
    else send({ ...reply, more: true });
  }
  send({ job, briefs });
}

self.onmessage = ({ data }) => {
  if (data.several) return answerAll(data);
  const reply = answer(data);
  if (reply) send(reply);
};
