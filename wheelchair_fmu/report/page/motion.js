// Where the chair was and what pushed it: series of one run that the scene draws.

import { present } from "page/draw";

const SMOOTH = 0.4; // s, over which differences of readings are taken

/** A channel of a run at every row, straight between its readings: rows of several devices lie between one another's. NaN where
 *  it has none for long. Undefined where there is no such channel. */
function read(run, channel) {
  const values = run.channels[channel];
  run.read ??= {};
  return values && (run.read[channel] ??= between(run.time, values));
}

function between(time, values) {
  const { at, lapse } = present(time, values), out = values.slice();
  if (at.length === values.length || !at.length) return out;
  for (let i = 0, k = -1; i < out.length; i++) {
    while (k + 1 < at.length && at[k + 1] <= i) k++;
    const [a, b] = [at[k], at[k + 1]];
    if (a === undefined || b === undefined) { const only = a ?? b; if (Math.abs(time[i] - time[only]) <= lapse) out[i] = values[only]; }
    else if (time[b] - time[a] <= lapse) out[i] = values[a] + ((values[b] - values[a]) * (time[i] - time[a])) / (time[b] - time[a]);
  }
  return out;
}

/** Where the sensors say the chair went, {x, y, psi}: tracked, or reckoned from wheel speeds and yaw rate; null where neither
 *  is there. */
export function reckoned(run, results) {
  const [x, y, yaw, l, r, turn] = ["x", "y", "yaw", "wheel_speed_l", "wheel_speed_r", "yaw_rate"].map((c) => read(run, c)), { time } = run, n = time.length;
  const speed = (i) => (l && r ? (l[i] + r[i]) / 2 : (l ?? r)?.[i]);
  if (x && y) return { x, y, psi: yaw ?? results["chair.psi"], tracked: true };
  if (!turn || !(l ?? r)) return null;
  const out = { x: new Float64Array(n), y: new Float64Array(n), psi: new Float64Array(n), tracked: false };
  let psi = results["chair.psi"][0];
  [out.x[0], out.y[0], out.psi[0]] = [results["chair.x"][0], results["chair.y"][0], psi];
  for (let i = 1; i < n; i++) {
    const dt = time[i] - time[i - 1], w = turn[i - 1], v = speed(i - 1); // in a gap, and after it, nobody knows
    psi += (w * dt) / 2;
    out.x[i] = out.x[i - 1] + v * Math.cos(psi) * dt;
    out.y[i] = out.y[i - 1] + v * Math.sin(psi) * dt;
    psi += (w * dt) / 2;
    out.psi[i] = psi;
  }
  return out;
}

/** How far each rear wheel has rolled, {l, r} in m. */
export function rolled(time, results, tread) {
  const { "chair.u": u, "chair.psi_dot": turn } = results, out = { l: new Float64Array(time.length), r: new Float64Array(time.length) };
  for (let i = 1; i < time.length; i++) {
    const dt = time[i] - time[i - 1], ahead = u[i] * dt, around = (turn[i] * dt * tread) / 2;
    out.l[i] = out.l[i - 1] + ahead + around; // clockwise from above: the left wheel goes further
    out.r[i] = out.r[i - 1] + ahead - around;
  }
  return out;
}

/** The force (N) and moment (N m) that the model would need more, for its speed and yaw rate to change as was measured:
 *  mass and moment of inertia times the rate at which model and readings part, by sample; null where that was not measured. */
export function lacking(run, { predicted }, { mass, inertia }) {
  const { time } = run, channels = Object.fromEntries(["wheel_speed_l", "wheel_speed_r", "yaw_rate"].map((c) => [c, read(run, c)])), sides = ["wheel_speed_l", "wheel_speed_r"].filter((c) => channels[c]);
  const parting = (names) => (i) => slope(time, i, (k) => names.reduce((sum, c) => sum + channels[c][k] - predicted[c][k], 0) / names.length);
  const speed = parting(sides), turn = parting(["yaw_rate"]);
  return { force: sides.length === 2 ? (i) => mass * speed(i) : null, moment: channels.yaw_rate ? (i) => inertia * turn(i) : null };
}

/** The slope of a noisy series `at` sample `i`: between its means over SMOOTH before and after. */
function slope(time, i, at) {
  const mean = (way) => {
    let sum = 0, count = 0, k = i;
    for (; k >= 0 && k < time.length && Math.abs(time[k] - time[i]) <= SMOOTH; k += way) { const v = at(k); if (Number.isFinite(v)) { sum += v; count++; } }
    return { value: sum / count, end: time[k - way] };
  };
  const [before, after] = [-1, 1].map(mean), span = (after.end - before.end) / 2;
  return after.end > time[i] && before.end < time[i] ? (after.value - before.value) / span : NaN;
}
