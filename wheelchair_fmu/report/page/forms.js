// The workbench's forms: what the campaign says of its runs, columns, noise and chair. Each change is sent at once.

import { h, symbols } from "page/dom";
import { course, extent, svg } from "page/draw";
import { decimal, significant, unitText } from "page/numbers";
import { bearer, capital, channelOf, listed } from "page/words";

const ROLES = { fit: "fit", holdout: "held out" };
const ROLLING = /^(F_r|wheel_)/; // channels that may be logged as torques or as turning
const SAID = 2; // faults that are told in one place
const FEW = 6; // runs that are shown without asking where something is wrong
const MANY = 12; // columns that nothing is taken from, above which they are folded
const WIDE = 110, HIGH = 30; // px of a signal beside its column
const CENTRE = "the centre of mass", AXLE = "the middle of the rear axle"; // from where points count
const PUSHES = ["F_rl", "F_rr"];

const table = (kind, heads, rows) => {
  for (const row of rows) [...row.children].forEach((cell, i) => { cell.dataset.head = heads[i]; }); // for narrow screens
  return made(kind, heads, rows);
};

const made = (kind, heads, rows) => h("div", { class: "wide" }, h("table", { class: kind }, h("thead", {}, h("tr", {}, heads.map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, rows)));

const select = (label, options, value, changed) => {
  const made = h("select", { "aria-label": label, onchange: () => changed(made.value) }, Object.entries(options).map(([v, words]) => h("option", { value: v }, words)));
  made.value = value;
  return made;
};

const text = (label, value, changed, more = {}) => {
  const made = h("input", { type: "text", "aria-label": label, value: value ?? "", autocomplete: "off", onchange: () => changed(made.value.trim()), ...more });
  return made;
};

/** What is wrong with a run, a column or a value, or was only guessed, where it is mended: filled by `mark`. */
const wrong = (of) => h("small", { class: "wrong", ...of });

/** Put what is wrong, or to be looked at, beside what it is of. */
export function mark(faults) {
  const told = faults.filter((f) => (f.severity === "warning" ? Boolean(f.column) : f.severity !== "note"));
  for (const place of document.querySelectorAll("#forms .wrong")) {
    const { column, at } = place.dataset, files = place.dataset.files?.split("\n") ?? [];
    const of = told.filter((f) => (at ? f.at === at : files.includes(f.file) && (f.column ?? undefined) === column)), bad = of.some((f) => f.severity === "error"), said = [...new Set(of.map((f) => f.what))];
    place.classList.toggle("guess", !bad);
    const beside = place.previousElementSibling, typed = beside?.matches("input, select") ? beside : beside?.querySelector("input, select");
    if (at) typed.setAttribute("aria-invalid", bad);
    place.textContent = said.slice(0, SAID).map((what) => `${capital(what)}.`).join(" ") + (said.length > SAID ? ` And ${said.length - SAID} more.` : "");
  }
}

export function runs(bench) {
  const { campaign, faults } = bench.state, list = Array.isArray(campaign.run) ? campaign.run : [], errors = faults.filter((f) => f.severity === "error");
  const rows = list.map((run, i) => {
    const files = run.files ? Object.values(run.files) : [run.file ?? "?"], name = run.name ?? files[0];
    return h("tr", {}, h("th", { scope: "row" }, name, files.length > 1 || files[0] !== name ? h("small", {}, files.join(", ")) : null, wrong({ "data-files": files.join("\n") })),
      h("td", {}, select(`role of ${name}`, ROLES, run.role, (role) => bench.save((c) => { c.run[i].role = role; }))),
      h("td", {}, text(`manoeuvre of ${name}`, run.manoeuvre, (words) => bench.save((c) => { c.run[i].manoeuvre = words; }))),
      h("td", {}, pushed(bench, run, i, name, files, errors)),
      h("td", {}, text(`speed at the start of ${name} [m/s]`, run.u0, (value) => bench.save((c) => { put(c.run[i], "u0", value); }), { size: 6, inputmode: "decimal" }), wrong({ "data-at": `run.${i}.u0` })),
      h("td", {}, h("button", { type: "button", class: "quiet", "aria-label": `remove ${name}`, onclick: () => bench.remove(files) }, "remove")));
  });
  const axes = select("axes", { "SAE-J670": "y to the right (SAE J670)", "ISO-8855": "y to the left (ISO 8855)" }, campaign.campaign?.axes, (value) => bench.save((c) => { c.campaign.axes = value; }));
  const kept = list.filter((run) => run.role === "holdout").length;
  return h("details", { open: (errors.some((f) => f.file && !f.column) && list.length <= FEW) || faulty(bench, "run.") }, h("summary", {}, `Runs: ${list.length - kept} to fit, ${kept} held out`),
    h("p", { class: "row" }, h("label", {}, "campaign ", text("name of the campaign", campaign.campaign?.name, (name) => bench.save((c) => { c.campaign.name = name; }))), h("label", {}, "axes ", axes), wrong({ "data-at": "campaign.axes" })),
    table("runs", ["run", "role", "manoeuvre", "pushes", "speed at the start, about [m/s]", "take it out"], rows));
}

/** Whether somebody pushed: where no file tells, it has to be said. */
function pushed(bench, run, i, name, files, errors) {
  const still = PUSHES.every((force) => run.constant?.[force] === 0), missing = errors.some((f) => files.includes(f.file) && /^the push on .* is missing/.test(f.what));
  if (!still && !missing) return "as recorded";
  return select(`pushes in ${name}`, { "": "as recorded", none: "nobody pushed" }, still ? "none" : "", (value) => bench.save((c) => {
    const constant = Object.fromEntries(Object.entries(c.run[i].constant ?? {}).filter(([force]) => !PUSHES.includes(force)));
    if (value) for (const force of PUSHES) constant[force] = 0;
    if (Object.keys(constant).length) c.run[i].constant = constant;
    else delete c.run[i].constant;
  }));
}

/** The columns of all files, or of each device's, with what every one of them holds. */
export function columns(bench) {
  const { campaign, headers, channels } = bench.state, devices = Array.isArray(campaign.recording) ? campaign.recording : null;
  const options = { "": "not used", ...Object.fromEntries(channels.map((c) => [c.name, `${c.meaning}${bracket(c.unit)} · ${c.name}`])) };
  const known = (devices ?? []).map((device, i) => ({ name: device.device, files: filesOf(campaign, device.device), of: (content) => (content.recording[i].columns ??= {}), explicit: true }));
  const owned = new Set(known.flatMap(({ files }) => [...files])), others = devices ? bench.state.files.filter((file) => !owned.has(file)) : [];
  const plain = { name: "", files: devices ? new Set(others) : null, of: (content) => (content.columns ??= {}), explicit: false };
  const tables = devices ? [...known, ...(others.length ? [plain] : [])] : [plain];
  const needed = bench.state.faults.some((f) => f.column || (f.severity === "error" && f.what.includes("Columns and their units"))); // which are mended here
  return h("details", { open: Boolean(needed || devices) }, h("summary", {}, "Columns and their units"), tables.map((one) => {
    const record = devices?.find((d) => one.name && d.device === one.name), given = (record ?? campaign).columns ?? {}, rows = Object.keys(headers).filter((header) => !one.files || headers[header].some((f) => one.files.has(f))).map((header) => columnRow(bench, header, one, given, options, record));
    const heads = ["column", "signal", "is", "unit", "wheel radius [m], where the unit turns"], [used, rest] = [true, false].map((there) => rows.filter((row) => "used" in row.dataset === there)), all = !record && rest.length <= MANY;
    return h("div", {}, record ? device(bench, devices.indexOf(record)) : devices ? h("h3", {}, "Of no device", h("small", {}, `${listed(others)}: “find out” above looks for the device too`)) : null, all || used.length ? table("columns", heads, all ? rows : used) : null,
      rest.length && !all ? h("details", {}, h("summary", {}, `${rest.length} ${used.length ? "more " : ""}column${rest.length > 1 ? "s" : ""}${record?.markers ? ": markers, from which position, heading and the motion of the body are worked out" : ", which nothing is taken from"}`), table("columns", heads, rest)) : null);
  }));
}

/** A device's name and where it sits. */
function device(bench, i) {
  const { device: name, at, columns = {}, markers = {} } = bench.state.campaign.recording[i], [first, ...more] = filesOf(bench.state.campaign, name);
  const title = h("h3", {}, name, first && first !== name ? h("small", {}, more.length ? `${first} and ${more.length} more` : first) : null);
  if (!Object.keys(markers).length && !placed(bench, columns)) return title; // of which it makes no difference
  const change = (words) => bench.save((c) => {
    if (words) c.recording[i].at = pointOf(words) ?? words;
    else delete c.recording[i].at;
  });
  return h("div", {}, title, h("p", { class: "row" }, h("label", {}, `where it sits: m forward, m to the right of ${Object.keys(markers).length ? AXLE : CENTRE} `, text(`where ${name} sits`, Array.isArray(at) ? at.join(", ") : at, change, { size: 12, placeholder: Object.keys(markers).length ? "as on the axle" : "as at the centre" })), wrong({ "data-at": `recording.${i}.at` })));
}

/** Is any of these channels one that reads otherwise at another place? */
const placed = (bench, columns) => bench.state.channels.some((c) => c.placed && c.name in columns);

/** Where one channel is read, of which the rest of its device need not sit. */
function point(bench, channel, record) {
  const { sensor } = bench.state.campaign, at = sensor?.[channel]?.at, change = (words) => bench.save((c) => {
    const { [channel]: _, ...rest } = c.sensor ?? {};
    c.sensor = words ? { ...rest, [channel]: { at: pointOf(words) ?? words } } : rest;
    if (!Object.keys(c.sensor).length) delete c.sensor;
  });
  const usual = record ? "as its device" : "at the centre";
  return [h("label", { class: "read-at", title: `m forward, m to the right of ${CENTRE}` }, "read at: m forward, m to the right ", text(`where ${channelOf(channel)} is read`, Array.isArray(at) ? at.join(", ") : at, change, { size: 9, placeholder: usual })), wrong({ "data-at": `sensor.${channel}` })];
}

/** Two numbers, as "0.09, 0.04" or "0,09 0,04": a comma parts them where nothing else does. Null for any other words. */
export function pointOf(words) {
  const parts = /[;\s]/.test(words) ? words.split(/,?[;\s]+/) : words.split(","), point = parts.map(decimal);
  return point.length === 2 && point.every(Number.isFinite) ? point : null;
}

/** The files of a device, in all runs. */
const filesOf = (campaign, device) => new Set((Array.isArray(campaign.run) ? campaign.run : []).map((run) => run.files?.[device]).filter(Boolean));

function columnRow(bench, header, place, given, options, record) {
  const called = place.name ? `${header} of ${place.name}` : header;
  const { headers, signals } = bench.state, { bare, own } = parted(header), entry = Object.entries(given).find(([, v]) => (v.column ?? v) === header);
  const channel = entry?.[0] ?? (!place.explicit && bare in options ? bare : ""), was = entry?.[1] ?? {};
  const unit = text(`unit of ${called}`, was.unit ?? own, () => change(), { size: 8, placeholder: header.match(/\(([^()]*)\)\s*$/)?.[1] ?? "" }), radius = text(`wheel radius for ${called} [m]`, was.radius, () => change(), { size: 6, placeholder: bench.state.campaign.wheel?.R ?? "" });
  const rolls = () => { radius.hidden = !ROLLING.test(which.value); };
  const marker = Object.values(record?.markers ?? {}).some((m) => header.startsWith(`${m}.`));
  const unused = bench.state.times.includes(header) ? { "": "the time of its file" } : marker ? { "": "part of a marker" } : {};
  const derived = channel && !(channel in options) ? { [channel]: `${channelOf(channel)}, from which other signals are worked out` } : {};
  const which = select(`channel of ${called}`, { ...options, ...unused, ...derived }, channel, () => change());
  const change = () => { rolls(); return bench.save((c) => map(c, place, header, bare, own, which.value, unit.value.trim(), radius.hidden ? "" : radius.value.trim())); };
  const turned = h("input", { type: "checkbox", checked: was.sign < 0, "aria-label": `${called} turned round`, onchange: () => { const now = which.value; return now && bench.save((c) => turn(c, place, header, bare, now, turned.checked)); } });
  rolls();
  const files = headers[header].filter((f) => !place.files || place.files.has(f)), seen = signals[header] ?? {}, first = files.find((f) => seen[f]);
  const told = bench.state.faults.some((f) => f.column === header && files.includes(f.file)); // which has to be in sight
  return h("tr", { "data-used": channel || told ? "" : null }, h("th", { scope: "row" }, header, h("small", {}, files.length === 1 ? files[0] : `${files.length} files`), wrong({ "data-column": header, "data-files": files.join("\n") })), h("td", {}, signal(first ? seen[first] : [])), h("td", {}, which, bench.state.channels.some((c) => c.name === channel && c.mirrored) && (record?.axes ?? bench.state.campaign.campaign?.axes) === "ISO-8855" ? h("small", {}, "as in the file, where y points to the left; turned for the model") : null, channel && channel !== "time" ? h("label", { class: "read-at", title: "what is positive in the file is negative here" }, turned, was.sign < 0 ? "turned round: what is positive in the file is negative here" : "turn it round") : null, placed(bench, { [channel]: true }) ? point(bench, channel, record) : null), h("td", {}, unit), h("td", {}, radius));
}

/** A column's values over time, small, with the greatest and the least of them. */
function signal(values) {
  const there = values.map((v) => v ?? NaN);
  if (!there.some(Number.isFinite)) return h("small", {}, "no numbers");
  const [low, high] = extent(there), down = (v) => 2 + (HIGH - 4) * (1 - (v - low) / (high - low || 1));
  return h("span", { class: "signal" }, svg("svg", { width: WIDE, height: HIGH, viewBox: `0 0 ${WIDE} ${HIGH}`, "aria-hidden": "true" },
    low < 0 && high > 0 ? svg("path", { d: `M0 ${down(0)}H${WIDE}`, stroke: "var(--line)" }) : null, course(there.map((_, i) => (i * WIDE) / there.length), there.map(down), "var(--model)", { "stroke-width": 1.2 })),
  h("small", {}, low === high ? `always ${significant(low, 3)}` : `${shown(low)} to ${shown(high)}`));
}

/** Three digits, also of what is rounded up to the next power of ten. */
const shown = (value) => significant(Number(value.toPrecision(3)), 3);

/** Writes into the columns of a campaign or device that `header` is `channel`; what its header says by itself needs no entry. A
 *  sentence where another column was that. */
function map(content, place, header, bare, own, channel, unit, radius) {
  const all = place.of(content), before = all[channel], other = before && (before.column ?? before), was = Object.values(all).find((v) => (v.column ?? v) === header);
  for (const [name, value] of Object.entries(all)) if ((value.column ?? value) === header) delete all[name];
  if (channel && (place.explicit || channel !== bare || unit !== own || radius || was?.sign < 0)) {
    all[channel] = { ...(typeof was === "object" ? was : {}), column: header };
    if (unit && unit !== own) all[channel].unit = unit;
    else delete all[channel].unit;
    put(all[channel], "radius", radius);
  }
  if (!place.explicit && Object.keys(all).length === 0) delete content.columns;
  return other && other !== header ? `“${other}” was the ${channelOf(channel)} before, and is not used now.` : "";
}

/** Writes that what is positive in `header` is negative in the channel, or is not. */
function turn(content, place, header, bare, channel, on) {
  const all = place.of(content), was = all[channel], { sign: _, ...rest } = typeof was === "object" ? was : { column: was ?? header };
  if (on) all[channel] = { ...rest, sign: -1 };
  else if (!place.explicit && channel === bare && Object.keys(rest).length === 1) delete all[channel]; // as its header says
  else all[channel] = rest;
  if (!place.explicit && Object.keys(all).length === 0) delete content.columns;
}

/** What sensors are worth: one standard deviation for each that is in the recordings. */
export function noise(bench) {
  const { campaign, headers, channels, noise: found } = bench.state, mapped = campaign.columns ?? {};
  const columnUnit = {};
  for (const header of Object.keys(headers)) {
    const { bare, own } = parted(header), entry = Object.entries(mapped).find(([, v]) => (v.column ?? v) === header);
    columnUnit[entry?.[0] ?? bare] = entry?.[1].unit ?? own;
  }
  const fields = channels.filter((c) => (c.name in columnUnit || c.name in found) && c.name !== "time").map((c) => {
    const seen = found[c.name];
    return field(`noise.${c.name}`, c.name, c.meaning + bracket(columnUnit[c.name] || c.unit), campaign.noise?.[c.name], (value) => bench.save((content) => { put((content.noise ??= {}), c.name, value); }),
      seen === undefined ? "" : `${significant(seen, 2)} ${c.unit === "1" ? "" : c.unit}`.trim());
  });
  return h("details", { open: faulty(bench, "noise.") }, h("summary", {}, "Noise of the sensors"),
    h("p", { class: "hint" }, "One standard deviation, in the unit shown or with one of its own, as in 0.2 deg/s. Where none is given, the one in grey is used: it is estimated from the samples."),
    h("div", { class: "grid" }, fields));
}

export function chair(bench) {
  const { campaign, parameters } = bench.state;
  const fields = parameters.map((p) => {
    const [group, key] = grouped(p.name);
    return field(p.name, p.name, p.meaning + bracket(p.unit), campaign[group]?.[key], (value) => bench.save((c) => { put((c[group] ??= {}), key, value); }), p.default);
  });
  const open = Array.isArray(campaign.recording) && ["m", "a", "b"].some((key) => campaign.chair?.[key] === undefined); // which no file tells
  return h("details", { open: open || faulty(bench, ...parameters.map((p) => p.name)) }, h("summary", {}, "What is known of the chair"),
    h("p", { class: "hint" }, "What you leave empty is taken as in grey, and calibrated where runs tell it."), h("div", { class: "grid" }, fields), laws(bench));
}

/** Which laws the model at hand has; to choose another makes another model, which can be undone. */
function laws(bench) {
  const { laws: chosen, every_law: every } = bench.state, of = (kind) => every.filter((law) => law.of === kind), says = (kind) => every.find((law) => law.of === kind && law.name === chosen[kind])?.says ?? "";
  const one = (kind) => h("label", {}, h("span", {}, capital(`law of the ${bearer(kind)}`), h("small", {}, says(kind))),
    select(`law of the ${bearer(kind)}`, Object.fromEntries([...new Set([...of(kind).map((law) => law.name), chosen[kind]])].map((name) => [name, name.replaceAll("_", " ")])), chosen[kind], (name) => bench.law(kind, name)));
  return h("div", { class: "laws" }, h("p", { class: "hint" }, "Laws say how forces follow from motion. Another one makes another model, by which the next calibration and diagnosis go; undo brings the one before back."), h("div", { class: "grid" }, Object.keys(chosen).map(one)));
}

/** How well it is known: a standard deviation about each value. */
export function priors(bench) {
  const { campaign, parameters } = bench.state;
  const fields = parameters.filter((p) => p.calibrated).map((p) => {
    const [group, key] = grouped(p.name), value = campaign[group]?.[key] ?? p.default;
    const change = (sd) => bench.save((c) => {
      const all = (c.prior ??= {});
      delete all[p.name];
      put((all[group] ??= {}), key, sd);
    });
    return field(`prior.${p.name}`, p.name, p.meaning + bracket(p.unit), campaign.prior?.[p.name] ?? campaign.prior?.[group]?.[key], change,
      significant(p.uncertainty * (Math.abs(value) || 1), 2), ` = ${value} ±`, `prior of ${p.name}`);
  });
  return h("details", { open: faulty(bench, "prior.") }, h("summary", {}, "How sure these values are"),
    h("p", { class: "hint" }, "These values are calibrated, and stay as near to what you gave as you are sure of it. Where you do not say, the standard deviation in grey is used."),
    h("div", { class: "grid" }, fields));
}

/** " [m/s]"; nothing for a plain number. */
const bracket = (unit) => (unitText(unit) ? ` [${unitText(unit)}]` : "");

const grouped = (name) => [name.slice(0, name.indexOf(".")), name.slice(name.indexOf(".") + 1)];

/** "yaw_rate [deg/s]" without its bracket, and what the bracket holds. */
const parted = (header) => {
  const [bare, own] = header.match(/^(.*?)\s*\[([^\]]*)\]\s*$/)?.slice(1) ?? [header, ""];
  return { bare, own };
};

const field = (at, name, says, value, changed, placeholder, more = "", label = name) =>
  h("label", {}, h("span", {}, symbols(capital(says)), h("small", {}, h("code", {}, name), more)), text(`${label}: ${says}`, value, changed, { placeholder, inputmode: "decimal" }), wrong({ "data-at": at }));

/** Is something wrong with a value of one of these names? */
const faulty = ({ state }, ...names) => state.faults.some((f) => f.severity === "error" && names.some((name) => f.at?.startsWith(name)));

/** A number where it is one; the text as it is where not, so that the check can say so; nothing where nothing is. */
function put(table, key, value) {
  const number = decimal(value);
  if (value === "") delete table[key];
  else table[key] = Number.isFinite(number) ? number : value;
}
