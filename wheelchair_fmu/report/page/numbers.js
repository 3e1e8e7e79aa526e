// Numbers and units as people read them.

const UNITS = {
  1: "", "m/s2": "m/s²", "N.m": "N m", "kg.m2": "kg m²", "N.s/m": "N s/m", "N.s2/m2": "N s²/m²",
  "N.s": "N s", "N.m.s": "N m s", "N.m.s/rad": "N m s/rad", "N.m/rad": "N m/rad", deg: "°", "deg/s": "°/s",
};

/** A unit's name in print; "1" is none. */
export const unitText = (unit) => UNITS[unit] ?? unit;

/** A number, as it is written, with its unit; degrees stand close, and what is not known has none. */
export const beside = (text, unit) => (text === "–" ? text : `${text}${unit && unit !== "°" ? " " : ""}${unit}`);

/** How a quantity is shown: {unit, factor} from SI. */
export const display = (record) => record?.display?.[0] ?? { unit: record?.unit ?? "1", factor: 1 };

/** The same of a unit alone: angles are told in degrees. */
export const degrees = (unit) => (/^rad(\/s)?$/.test(unit) ? { unit: unit.replace("rad", "deg"), factor: 180 / Math.PI } : { unit, factor: 1 });

/** `value` with so many significant digits, without an exponent where that is short. */
export function significant(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size > 5) return minus(value.toExponential(digits - 1).replace("e-", "e−").replace("e+", "e"));
  return minus(value.toFixed(Math.max(0, digits - 1 - size)));
}

/** `value` to the decimal place at which `noise` begins, so that readings of one channel stand under one another. */
export function toPlace(value, noise) {
  if (!Number.isFinite(value)) return "–";
  const place = noise > 0 ? Math.min(8, Math.max(0, -Math.floor(Math.log10(noise) + 1e-9))) : 3;
  return unsigned(minus(value.toFixed(place)));
}

export const UNSEEN = "not seen"; // a size whose error is a hundred times as large, and more

/** "1.607 ± 0.008 N": the error to two digits at most, the estimate to the same place. */
export function withError(estimate, se, record) {
  const { unit, factor } = display(record), suffix = unitText(unit), space = suffix === "°" || !suffix ? "" : " ";
  const [value, error] = [estimate * factor, se === null ? null : se * factor];
  if (error === null || !(error > 0)) return `${significant(value)}${space}${suffix}`;
  if (value !== 0 && error > 100 * Math.abs(value)) return UNSEEN;
  const coarse = Math.max(error, finest(record)), place = placeOf(coarse);
  return `${unsigned(minus(value.toFixed(place)))} ± ${coarse.toFixed(place)}${space}${suffix}`;
}

/** "1.61 (1.48 to 1.73) N": an estimate in its 95 % interval. */
export function withInterval(estimate, ends, record) {
  const { unit, factor } = display(record), suffix = unitText(unit), half = ((ends[1] - ends[0]) / 2) * factor;
  if (!(half > 0)) return withError(estimate, null, record);
  if (estimate !== 0 && half > 200 * Math.abs(estimate * factor)) return UNSEEN;
  const [value, low, high] = [estimate, ...ends].map((v) => unsigned(minus((v * factor).toFixed(placeOf(Math.max(half, finest(record)))))));
  return beside(`${value} (${low} to ${high})`, suffix);
}

/** The least error that is told of a size, as it is shown: a thousandth of what would matter. */
const finest = (record) => (Math.abs(record.delta ?? 0) * display(record).factor) / 1000;

/** The decimal place to which an error has two digits at most. */
function placeOf(error) {
  const [first, exponent] = error.toExponential(0).split("e").map(Number);
  return Math.min(8, Math.max(0, (first < 3 ? 1 : 0) - exponent));
}

/** The ends of an interval of 95 %: the diagnosis' own, or else by the standard error. */
export const endsOf = ({ estimate, se, interval }) => interval ?? [estimate - 1.96 * (se ?? 0), estimate + 1.96 * (se ?? 0)];

/** An estimate {estimate, se, interval} with what it is uncertain by: its interval, where there is one, allows for runs that
 *  differ by more than their noise; a standard error does not. */
export const uncertain = (v, record) => (v.interval ? withInterval(v.estimate, v.interval, record) : withError(v.estimate, v.se, record));

/** A size, or zero where a fit has left next to nothing of it. */
export const settled = (value, record) => (Math.abs(value) < 1e-6 * (record.delta || Math.abs(record.default ?? 0)) ? 0 : value);

/** A value in the unit it is shown in. */
export function inUnit(value, record, digits = 3) {
  const { unit, factor } = display(record), suffix = unitText(unit);
  return `${significant(settled(value, record) * factor, digits)}${suffix && suffix !== "°" ? " " : ""}${suffix}`;
}

/** "−4.2 to 6.8 °": both ends to the digits that tell them apart. */
export function between(from, to, record) {
  const { unit, factor } = display(record), [a, b] = [from * factor, to * factor], span = Math.abs(b - a);
  const place = span > 0 ? Math.min(Math.max(0, 1 - Math.floor(Math.log10(span))), 4) : 2;
  const text = (v) => unsigned(minus(v.toFixed(place)));
  return `${text(a)} to ${text(b)}${unit === "deg" ? "" : " "}${unitText(unit)}`.trim();
}

/** A probability, none of which is said to be certain. */
export function chance(p) {
  if (p === null || p === undefined) return "–";
  if (p > 0.999) return "> 99.9 %";
  if (p < 0.001) return "< 0.1 %";
  return `${(100 * p).toFixed(p > 0.99 || p < 0.01 ? 1 : 0)} %`;
}

/** Whitened RMS: two decimals are what its own noise allows. */
export const rms = (value) => (value === null || value === undefined || Number.isNaN(value) ? "–" : value.toFixed(2));

const minus = (text) => text.replace(/^-/, "−");
const unsigned = (text) => text.replace(/^−(0(\.0*)?)$/, "$1"); // zero has no sign

/** A number as people type it, with a point or a comma; NaN where it is none. */
export const decimal = (words) => Number(String(words).replace(",", "."));
