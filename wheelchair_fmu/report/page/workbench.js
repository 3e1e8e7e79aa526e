// The workbench: forms over a session that the server keeps. Nothing lives only in this page.

import { byId, h } from "page/dom";
import { rms, significant, unitText } from "page/numbers";

const POLL = 400; // ms between looks at a running job
const TYPED = 300; // ms without a key after which an expression is checked
const ROLES = { fit: "fit", holdout: "held out" };

class Refused extends Error {}

/** The address of this piece of work. The first page has none until one is begun for it. */
const place = location.pathname === "/" ? begun() : Promise.resolve(location.pathname.replace(/\/$/, ""));

async function begun() {
  const { id } = await answered(fetch("/sessions", { method: "POST", headers: { "x-workbench": "1" } }));
  history.replaceState(null, "", `/s/${id}`);
  return `/s/${id}`;
}

async function answered(asked) {
  const response = await asked, body = await response.json();
  if (!response.ok) throw new Refused(body.error ?? response.statusText);
  return body;
}

async function ask(path, options = {}) {
  return answered(fetch(`${await place}/${path}`, { ...options, headers: { "x-workbench": "1", ...options.headers } }));
}

const send = (method, path, content) => ask(path, { method, body: JSON.stringify(content), headers: { "content-type": "application/json" } });

/** What goes wrong is said at the top, and stands until something goes right. */
async function tried(act) {
  try {
    const result = await act();
    byId("error").hidden = true;
    return result;
  } catch (error) {
    byId("error").textContent = error instanceof Refused ? error.message : `the workbench does not answer (${error.message}); is it still running?`;
    byId("error").hidden = false;
    byId("error").scrollIntoView({ block: "nearest" });
    return null;
  }
}

class Workbench {
  async open() {
    this.listen();
    await this.take(() => ask("state"));
  }

  /** Ask the server for something that answers with the new state, and show it all. */
  async take(act) {
    const state = await tried(act);
    this.here = location.pathname.replace(/\/$/, "");
    if (state) this.show(state);
    return state;
  }

  show(state) {
    this.state = state;
    byId("name").textContent = state.campaign?.campaign?.name ?? "";
    this.showFaults();
    byId("forms").replaceChildren(...(state.campaign && state.files.length ? [runs(this), columns(this), noise(this), chair(this), priors(this)] : []));
    this.showHistory();
    this.showEffects();
    this.showJob(state.job);
    this.showReport();
    byId("earlier").replaceChildren(...(state.earlier.length ? ["Earlier work: ", ...state.earlier.map((s) => h("a", { class: "button", href: `/s/${s.id}` }, s.name))] : []));
  }

  showFaults() {
    const { faults, files } = this.state, errors = faults.filter((f) => f.severity === "error").length;
    const tally = !files.length ? "" : errors ? `${errors} fault${errors > 1 ? "s" : ""} to mend before anything can be concluded` : "These recordings can be read.";
    const lines = (severity) => h("ul", {}, faults.filter((f) => f.severity === severity).map((f) => h("li", { "data-severity": severity }, f.text)));
    const remarks = faults.length - errors;
    byId("faults").replaceChildren(h("p", {}, h("b", {}, tally)), lines("error"),
      remarks ? h("details", {}, h("summary", {}, `${remarks} remark${remarks > 1 ? "s" : ""}`), lines("warning"), lines("note")) : "");
    this.ready = files.length > 0 && !errors;
    this.enable();
  }

  enable() {
    const busy = this.state.job?.state === "running";
    for (const id of ["calibrate", "diagnose", "add"]) byId(id).disabled = busy || !this.ready;
    byId("cancel").hidden = !busy;
    const { at, steps } = this.state.history;
    byId("undo").disabled = busy || at <= 0;
    byId("redo").disabled = busy || at >= steps.length - 1;
  }

  showHistory() {
    const { at, steps } = this.state.history;
    byId("history").replaceChildren(...steps.map((step, i) => h("li", { "aria-current": i === at ? "step" : null, class: i > at ? "undone" : null },
      step.label.replaceAll("_", " "), step.ladder ? h("small", {}, fall(step.ladder)) : null)));
    byId("export-variant").href = `${this.here}/export/variant.toml`;
    byId("export-fmu").href = `${this.here}/export/Wheelchair.fmu`;
    byId("export-ssv").href = `${this.here}/export/parameters.ssv`;
  }

  showEffects() {
    const { effects, words } = this.state, select = byId("effect"), chosen = select.value;
    select.replaceChildren(...effects.map((e) => h("option", { value: e.id, title: e.title }, `${e.id.replaceAll("_", " ")}${e.own ? " (your own)" : ""}`)));
    if (effects.some((e) => e.id === chosen)) select.value = chosen;
    if (byId("readable").childElementCount) return;
    byId("readable").append(...words.readable.map((q) => h("option", { value: q.name })));
    byId("own").elements.to.append(...words.targets.map((q) => h("option", { value: q.name, title: q.meaning }, `${q.name} [${unitText(q.unit) || "1"}]`)));
    byId("own").elements.to.value = "F_x";
    byId("words").append(...words.readable.map((q) => h("div", {}, h("code", {}, q.name), ` [${unitText(q.unit) || "1"}] ${q.meaning}`)));
  }

  showJob(job) {
    this.state.job = job;
    const box = byId("job");
    box.hidden = !job;
    if (job) {
      const told = { running: "…", done: "done", failed: "failed", cancelled: "cancelled; nothing was changed" }[job.state];
      const low = box.scrollTop + box.clientHeight > box.scrollHeight - 40;
      box.dataset.state = job.state;
      box.replaceChildren(...job.commands.map((c) => h("div", { class: "command" }, `$ ${c}`)), ...job.lines.map((l) => h("div", {}, l)), h("b", {}, told));
      if (low) box.scrollTop = box.scrollHeight;
    }
    this.enable();
    clearTimeout(this.polling);
    if (job?.state === "running") this.polling = setTimeout(() => this.poll(), POLL);
  }

  async poll() {
    const job = await tried(() => ask("job"));
    if (job?.state === "running" || !job) return this.showJob(job ?? this.state.job);
    await this.take(() => ask("state"));
  }

  showReport() {
    const { report } = this.state, frame = byId("report");
    byId("no-report").hidden = Boolean(report);
    byId("old-report").hidden = !(report && ["add", "calibrate"].includes(this.state.job?.kind) && this.state.job.state === "done");
    frame.hidden = !report;
    byId("export-report").toggleAttribute("href", Boolean(report));
    if (report) byId("export-report").href = `${this.here}/export/report.html`;
    if (report && this.reported !== report) frame.src = `${this.here}/report?${report}`;
    this.reported = report;
  }

  /** A form changed the campaign: send it, and show what the checks say. The forms stand as they are. */
  async save(change) {
    const content = structuredClone(this.state.campaign);
    change(content);
    const state = await tried(() => send("PUT", "campaign", content));
    if (!state) return;
    this.state = { ...state, job: this.state.job };
    this.showFaults();
    this.showHistory();
    byId("name").textContent = state.campaign.campaign?.name ?? "";
  }

  listen() {
    const drop = byId("drop"), job = (kind, more = {}) => this.take(() => send("POST", "jobs", { kind, ...more }));
    for (const id of ["files", "folder"]) byId(id).addEventListener("change", ({ target }) => this.upload([...target.files].map((f) => [f.webkitRelativePath || f.name, f])));
    drop.addEventListener("dragover", (event) => { event.preventDefault(); drop.classList.add("over"); });
    drop.addEventListener("dragleave", () => drop.classList.remove("over"));
    drop.addEventListener("drop", async (event) => { event.preventDefault(); drop.classList.remove("over"); this.upload(await dropped(event.dataTransfer)); });
    byId("calibrate").addEventListener("click", () => job("calibrate"));
    byId("diagnose").addEventListener("click", () => job("diagnose"));
    byId("add").addEventListener("click", () => job("add", { effect: byId("effect").value }));
    byId("cancel").addEventListener("click", () => this.take(() => ask("jobs", { method: "DELETE" })));
    byId("undo").addEventListener("click", () => this.take(() => send("POST", "history", { by: -1 })));
    byId("redo").addEventListener("click", () => this.take(() => send("POST", "history", { by: 1 })));
    this.listenToExpression(byId("own"));
  }

  listenToExpression(form) {
    const unit = byId("unit");
    const check = async () => {
      if (!form.elements.expression.value.trim()) return;
      const found = await tried(() => send("POST", "expression", { expression: form.elements.expression.value, to: form.elements.to.value }));
      if (!found) return;
      unit.dataset.state = found.unit ? "good" : "bad";
      unit.textContent = found.unit ? `the units fit where q is in ${unitText(found.unit) || "plain numbers"}` : found.why;
      byId("unit-name").textContent = found.unit ? unitText(found.unit) : "";
    };
    const soon = () => { clearTimeout(this.typing); this.typing = setTimeout(check, TYPED); };
    form.elements.expression.addEventListener("input", soon);
    form.elements.to.addEventListener("change", check);
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      const text = (name) => form.elements[name].value.trim(), number = (name) => form.elements[name].valueAsNumber;
      const content = { id: text("id"), title: text("title"), to: text("to"), expression: text("expression"), size: number("size"), lower: number("lower"), upper: number("upper") };
      if (await this.take(() => send("POST", "effects", content))) byId("effect").value = content.id;
    });
  }

  upload(files) {
    if (!files.length) return null;
    const most = this.state?.most_upload, all = files.reduce((sum, [, file]) => sum + file.size, 0);
    if (all > most) return tried(() => { throw new Refused(`${Math.ceil(all / 1e6)} MB at once is too much for the workbench, which takes ${most / 1e6} MB; add fewer at a time`); });
    const toml = files.find(([path]) => path.endsWith("campaign.toml")), first = toml ?? files[0];
    const base = first[0].slice(0, first[0].lastIndexOf("/") + 1), form = new FormData();
    for (const [path, file] of files) if (!file.name.startsWith(".")) form.append("files", file, path.startsWith(base) ? path.slice(base.length) : path);
    return this.take(() => ask("files", { method: "POST", body: form }));
  }
}

/** Every file of what was dropped, folders too, as [path, file]. */
async function dropped(transfer) {
  const walk = async (entry, at) => {
    if (entry.isFile) return [[at + entry.name, await new Promise((good, bad) => entry.file(good, bad))]];
    const reader = entry.createReader(), inside = [];
    for (;;) {
      const some = await new Promise((good, bad) => reader.readEntries(good, bad));
      if (!some.length) break;
      inside.push(...some);
    }
    return (await Promise.all(inside.map((e) => walk(e, `${at}${entry.name}/`)))).flat();
  };
  return (await Promise.all([...transfer.items].map((i) => i.webkitGetAsEntry()).filter(Boolean).map((e) => walk(e, "")))).flat();
}

const fall = (ladder) => `held out: ${ladder.map((s) => rms(s.heldout)).join(" → ")}`;

const table = (heads, rows) => {
  for (const row of rows) [...row.children].forEach((cell, i) => { cell.dataset.head = heads[i]; }); // for narrow screens
  return made(heads, rows);
};

const made = (heads, rows) => h("div", { class: "wide" }, h("table", {}, h("thead", {}, h("tr", {}, heads.map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, rows)));

const select = (label, options, value, changed) => {
  const made = h("select", { "aria-label": label, onchange: () => changed(made.value) }, Object.entries(options).map(([v, words]) => h("option", { value: v }, words)));
  made.value = value;
  return made;
};

const text = (label, value, changed, more = {}) => {
  const made = h("input", { type: "text", "aria-label": label, value: value ?? "", autocomplete: "off", onchange: () => changed(made.value.trim()), ...more });
  return made;
};

function runs(bench) {
  const { campaign } = bench.state, list = Array.isArray(campaign.run) ? campaign.run : [];
  const rows = list.map((run, i) => h("tr", {}, h("th", { scope: "row" }, run.file ?? "?"),
    h("td", {}, select(`role of ${run.file}`, ROLES, run.role, (role) => bench.save((c) => { c.run[i].role = role; }))),
    h("td", {}, text(`manoeuvre of ${run.file}`, run.manoeuvre, (words) => bench.save((c) => { c.run[i].manoeuvre = words; }))),
    h("td", {}, text(`speed at the start of ${run.file} [m/s]`, run.u0, (value) => bench.save((c) => { put(c.run[i], "u0", value); }), { size: 6, inputmode: "decimal" })),
    h("td", {}, h("button", { type: "button", class: "quiet", "aria-label": `remove ${run.file}`, onclick: () => bench.take(() => ask(`files/${run.file}`, { method: "DELETE" })) }, "remove"))));
  const axes = select("axes", { "SAE-J670": "y to the right (SAE J670)", "ISO-8855": "y to the left (ISO 8855)" }, campaign.campaign?.axes, (value) => bench.save((c) => { c.campaign.axes = value; }));
  return h("details", { open: true }, h("summary", {}, "Runs"),
    h("p", { class: "row" }, h("label", {}, "campaign ", text("name of the campaign", campaign.campaign?.name, (name) => bench.save((c) => { c.campaign.name = name; }))), h("label", {}, "axes ", axes)),
    table(["file", "role", "manoeuvre", "speed at the start, about [m/s]", ""], rows));
}

function columns(bench) {
  const { campaign, headers, channels } = bench.state, given = campaign.columns ?? {};
  const nothing = { "": "not used" }, options = { ...nothing, ...Object.fromEntries(channels.map((c) => [c.name, `${c.name} [${unitText(c.unit) || "1"}] ${c.meaning}`])) };
  const rows = Object.entries(headers).map(([header, files]) => {
    const { bare, own } = parted(header);
    const entry = Object.entries(given).find(([, v]) => (v.column ?? v) === header);
    const channel = entry?.[0] ?? (channels.some((c) => c.name === bare) ? bare : ""), was = entry?.[1] ?? {};
    const unit = text(`unit of ${header}`, was.unit ?? own, () => change(), { size: 8 }), radius = text(`wheel radius for ${header} [m]`, was.radius, () => change(), { size: 6 });
    const which = select(`channel of ${header}`, options, channel, () => change());
    const change = () => bench.save((c) => map(c, header, bare, own, which.value, unit.value.trim(), radius.value.trim()));
    return h("tr", {}, h("th", { scope: "row" }, header, h("small", {}, files.length === 1 ? files[0] : `${files.length} files`)), h("td", {}, which), h("td", {}, unit), h("td", {}, radius));
  });
  const needed = Object.keys(headers).length && bench.state.faults.some((f) => f.severity === "error");
  return h("details", { open: Boolean(needed) }, h("summary", {}, "Columns and their units"), table(["column", "is", "unit", "wheel radius [m], where the unit turns"], rows));
}

/** Writes into [columns] that `header` is `channel`; what its header says by itself needs no entry. */
function map(content, header, bare, own, channel, unit, radius) {
  const all = (content.columns ??= {});
  for (const [name, value] of Object.entries(all)) if ((value.column ?? value) === header) delete all[name];
  if (channel && (channel !== bare || unit !== own || radius)) {
    all[channel] = { column: header, ...(unit && unit !== own ? { unit } : {}) };
    if (radius) put(all[channel], "radius", radius);
  }
  if (!channel && bare && Object.keys(all).length === 0) delete content.columns;
}

/** What sensors are worth: one standard deviation for each that is in the recordings. */
function noise(bench) {
  const { campaign, headers, channels, noise: found } = bench.state, mapped = campaign.columns ?? {};
  const columnUnit = {};
  for (const header of Object.keys(headers)) {
    const { bare, own } = parted(header), entry = Object.entries(mapped).find(([, v]) => (v.column ?? v) === header);
    columnUnit[entry?.[0] ?? bare] = entry?.[1].unit ?? own;
  }
  const fields = channels.filter((c) => c.name in columnUnit && c.name !== "time").map((c) => {
    const seen = found[c.name];
    return field(c.name, c.meaning + bracket(columnUnit[c.name] || c.unit), campaign.noise?.[c.name], (value) => bench.save((content) => { put((content.noise ??= {}), c.name, value); }),
      seen === undefined ? "" : `${significant(seen, 2)} ${c.unit === "1" ? "" : c.unit}`.trim());
  });
  return h("details", {}, h("summary", {}, "Noise of the sensors"),
    h("p", { class: "hint" }, "One standard deviation, in the unit shown or with one of its own, as in 0.2 deg/s. Where none is given, the one in grey is used: it is estimated from the samples."),
    h("div", { class: "grid" }, fields));
}

function chair(bench) {
  const { campaign, parameters } = bench.state;
  const fields = parameters.map((p) => {
    const [group, key] = grouped(p.name);
    return field(p.name, p.meaning + bracket(p.unit), campaign[group]?.[key], (value) => bench.save((c) => { put((c[group] ??= {}), key, value); }), p.default);
  });
  return h("details", {}, h("summary", {}, "What is known of the chair"), h("div", { class: "grid" }, fields));
}

/** How well it is known: a standard deviation about each value. */
function priors(bench) {
  const { campaign, parameters } = bench.state;
  const fields = parameters.filter((p) => p.calibrated).map((p) => {
    const [group, key] = grouped(p.name), value = campaign[group]?.[key] ?? p.default;
    const change = (sd) => bench.save((c) => {
      const all = (c.prior ??= {});
      delete all[p.name];
      put((all[group] ??= {}), key, sd);
    });
    return field(p.name, `standard deviation about ${value}${bracket(p.unit)}`, campaign.prior?.[p.name] ?? campaign.prior?.[group]?.[key], change,
      significant(p.uncertainty * (Math.abs(value) || 1), 2), `prior of ${p.name}`);
  });
  return h("details", {}, h("summary", {}, "How sure these values are"),
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

const field = (name, says, value, changed, placeholder, label = name) =>
  h("label", {}, h("span", {}, name, h("small", {}, says)), text(`${label}: ${says}`, value, changed, { placeholder, inputmode: "decimal" }));

/** A number where it is one; the text as it is where not, so that the check can say so; nothing where nothing is. */
function put(table, key, value) {
  const number = Number(String(value).replace(",", "."));
  if (value === "") delete table[key];
  else table[key] = Number.isFinite(number) ? number : value;
}

const bench = new Workbench();
bench.open();
window.workbench = bench;
