// The workbench: forms over a session that the server keeps. Nothing lives only in this page.

import { byId, h, save, symbols } from "page/dom";
import { chair, columns, noise, priors, runs } from "page/forms";
import { rms, unitText } from "page/numbers";
import { capital, listed } from "page/words";

const POLL = 400; // ms between looks at a running job
const TYPED = 300; // ms without a key after which an expression is checked
const LATEST = 3; // pieces of earlier work that are in sight
const PLACE = /^(?:run )?(?<where>.+?): (?<what>.+)$/; // of a fault's sentence
const FIRST = { diagnose: "of ten short runs it takes about a minute", add: "it takes some seconds", try: "it takes some seconds" };
const DONE = { import: "the files were read together", calibrate: "calibrated", diagnose: "diagnosed", add: "added and refitted", try: "tried" };

/** What no file tells of a chair, where campaign.toml has it as it was given. */
const SIZES = {
  mass: (c) => c.chair?.m, person: () => null, radius: (c) => c.wheel?.R, track: (c) => c.chair?.t_r, cm_ahead: (c) => c.chair?.b, caster_track: (c) => c.chair?.t_f,
  wheelbase: (c) => (Number.isFinite(c.chair?.a) && Number.isFinite(c.chair?.b) ? Number((c.chair.a + c.chair.b).toFixed(6)) : undefined),
};
const PLACES = { m: "the mass of chair and rider", t_r: "how far the rear wheels are apart", a: "how far the casters' pivots are ahead of the centre of mass", b: "how far the rear axle is behind it", t_f: "how far the casters' pivots are apart" };

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
  before = Promise.resolve();

  async open() {
    this.listen();
    await this.take(() => ask("state"));
  }

  /** Ask the server for something that answers with the new state, and show it all. One after the other: an answer that was
   *  overtaken on its way would show an older state over a newer one. */
  take(act) {
    const mine = this.before.then(() => this.taken(act));
    this.before = mine.catch(() => null);
    return mine;
  }

  async taken(act) {
    const state = await tried(act);
    this.here = location.pathname.replace(/\/$/, "");
    if (state) this.show(state);
    return state;
  }

  show(state) {
    this.state = state;
    byId("name").textContent = state.files.length ? state.campaign?.campaign?.name ?? "" : "";
    this.showFaults();
    byId("forms").replaceChildren(...(state.campaign && state.files.length ? [runs(this), columns(this), noise(this), chair(this), priors(this)] : []));
    this.showHistory();
    this.showEffects();
    this.showJob(state.job);
    this.showOutcome();
    const earlier = state.earlier.map((s) => h("a", { class: "button", href: `/s/${s.id}` }, `${s.name}, ${when(s.at)}`)), older = earlier.splice(LATEST);
    byId("earlier").replaceChildren(...(earlier.length ? ["Earlier work: ", ...earlier] : []), older.length ? h("details", {}, h("summary", {}, `${older.length} older`), h("span", { class: "tools wide-tools" }, older)) : "");
  }

  showFaults() {
    const { faults, files, campaign } = this.state, errors = faults.filter((f) => f.severity === "error"), remarks = faults.filter((f) => f.severity !== "error");
    const kinds = byCause(errors).size, raw = !Array.isArray(campaign?.recording), by = raw ? ": find out above what is in these files, or mend them by hand" : "";
    const tally = !files.length && !errors.length ? "" : errors.length ? `${kinds} ${kinds > 1 ? "faults" : "fault"} to mend before anything can be concluded${by}` : "These recordings can be read.";
    byId("faults").replaceChildren(h("p", {}, h("b", {}, tally)), causes(errors),
      remarks.length ? h("details", {}, h("summary", {}, `${remarks.length} remark${remarks.length > 1 ? "s" : ""}`), causes(remarks)) : "");
    byId("lab").hidden = !files.length || (!errors.length && raw);
    byId("lab").firstElementChild.textContent = raw ? "What is in these files?" : "Read the files again, with other sizes";
    if (this.asked !== (this.asked = errors.length > 0)) byId("lab").open = this.asked; // else as the reader left it
    for (const [name, of] of Object.entries(SIZES)) sizeField(name).value ||= of(campaign ?? {}) ?? "";
    sizeField("person").placeholder = campaign?.rider?.m ?? ""; // it may be assumed: who does not give it has it assumed again
    byId("import").setAttribute("aria-pressed", errors.length > 0);
    byId("sample").hidden = byId("sample-hint").hidden = files.length > 0;
    byId("preview-link").hidden = !files.length;
    byId("preview").href = `${this.here}/preview`;
    this.ready = files.length > 0 && !errors.length;
    const assumed = Object.entries(PLACES).filter(([name]) => campaign?.chair?.[name] === undefined).map(([, words]) => words);
    byId("assumed").hidden = !this.ready || !assumed.length;
    byId("assumed").textContent = `Not given, and so taken from another chair: ${listed(assumed)}. Measure it and write it above under “What is known of the chair”: a wrong value there passes for an effect, or hides one.`;
    this.enable();
  }

  enable() {
    const busy = this.state.job?.state === "running", { at, steps } = this.state.history;
    for (const id of ["calibrate", "diagnose", "add"]) byId(id).disabled = busy || !this.ready;
    for (const id of ["import", "sample"]) byId(id).disabled = busy;
    for (const b of document.querySelectorAll("[data-add]")) b.disabled = busy || !this.ready;
    const own = byId("own").querySelector("[type=submit]");
    own.disabled = busy;
    own.textContent = this.ready ? "put it into the catalogue and try it" : "put it into the catalogue";
    byId("cancel").hidden = !busy;
    for (const [id, there, step, word] of [["undo", at > 0, steps[at], "undo"], ["redo", at < steps.length - 1, steps[at + 1], "redo"]]) {
      byId(id).disabled = busy || !there;
      byId(id).title = there ? `${word}: ${this.labelOf(step)}` : "";
    }
  }

  /** What a step did, in words. */
  labelOf(step) {
    if (step.label === "nominal") return "the model as given";
    if (step.label.startsWith("+ ")) return `with ${this.titleOf(step.label.slice(2))}`;
    return step.label.replaceAll("_", " ");
  }

  titleOf(id) {
    return this.state.effects.find((e) => e.id === id)?.title ?? id.replaceAll("_", " ");
  }

  /** Models only: what forms changed is undone and redone, but is no model. */
  showHistory() {
    const { at, steps } = this.state.history, models = steps.map((step, i) => ({ step, i })).filter(({ step, i }) => !i || step.file !== steps[i - 1].file), now = models.filter(({ i }) => i <= at).at(-1);
    byId("history").replaceChildren(...models.map((model) => h("li", { "aria-current": model === now ? "step" : null, class: model.i > at ? "undone" : null },
      capital(this.labelOf(model.step)), model.step.ladder ? h("small", {}, fall(model.step.ladder)) : null)));
    byId("export-report").disabled = !this.state.report;
  }

  /** The likeliest effects of the last diagnosis come first. */
  showEffects() {
    const { effects, words, outcome } = this.state, select = byId("effect"), chosen = select.value, order = new Map((outcome?.order ?? []).map((id, i) => [id, i]));
    const there = new Set(this.state.history.steps.slice(0, this.state.history.at + 1).map((s) => s.label)), all = effects.filter((e) => !there.has(`+ ${e.id}`)).sort((a, b) => (order.get(a.id) ?? 1e9) - (order.get(b.id) ?? 1e9));
    select.replaceChildren(...all.map((e) => h("option", { value: e.id }, `${capital(e.title)}${e.own ? " (your own)" : ""}`)));
    if (this.ranked === (outcome?.order ?? []).join() && all.some((e) => e.id === chosen)) select.value = chosen;
    this.ranked = (outcome?.order ?? []).join();
    if (byId("readable").childElementCount) return;
    byId("readable").append(...words.readable.map((q) => h("option", { value: q.name })));
    byId("own").elements.to.append(...words.targets.map((q) => h("option", { value: q.name, title: q.meaning }, `${q.name} [${unitText(q.unit) || "1"}]`)));
    byId("own").elements.to.value = "F_x";
    byId("words").append(...words.readable.map((q) => h("div", {}, h("code", {}, q.name), ` [${unitText(q.unit) || "1"}] ${q.meaning}`)));
  }

  showJob(job) {
    this.state.job = job;
    byId("job").hidden = byId("progress").hidden = !job;
    if (job) {
      const box = byId("job").querySelector("[role=log]"), low = box.scrollTop + box.clientHeight > box.scrollHeight - 40;
      box.replaceChildren(...job.commands.map((c) => h("div", { class: "command" }, `$ ${c}`)), ...job.lines.map((l) => h("div", {}, l)));
      if (low) box.scrollTop = box.scrollHeight;
      this.showProgress(job);
    }
    this.enable();
    clearTimeout(this.polling);
    if (job?.state === "running") this.polling = setTimeout(() => this.poll(), POLL);
  }

  /** How far it has come; how long it will take is said where one of its kind has been seen. */
  showProgress(job) {
    const [bar, words] = byId("progress").children, { usual, steps, seconds } = job, running = job.state === "running";
    byId("progress").dataset.state = job.state;
    bar.hidden = !running;
    if (usual) bar.value = Math.min(0.98, seconds / usual.seconds);
    else bar.removeAttribute("value");
    const left = usual && usual.seconds > seconds ? `about ${whole(usual.seconds - seconds)} left` : usual ? "longer than the last time" : FIRST[job.kind] ?? "";
    words.textContent = running ? [capital(job.lines.at(-1) ?? "starting"), `step ${Math.max(1, steps)}${usual ? ` of about ${Math.max(usual.steps, steps)}` : ""}`, `${whole(seconds)} so far`, left].filter(Boolean).join(" · ")
      : job.state === "done" ? `${capital(DONE[job.kind] ?? job.kind)}, in ${whole(seconds)}.` : job.state === "cancelled" ? "Cancelled; nothing was changed." : `Failed: ${job.lines.at(-1) ?? "nothing was said"}`;
    const said = running ? job.lines.at(-1) ?? "starting" : words.textContent;
    if (byId("said").textContent !== said) byId("said").textContent = said;
    const trying = job.kind === "try", { at } = this.state.history;
    if (trying && running) this.triedAt = at; // what was tried is told of this model alone
    const found = trying && job.state === "done" && this.triedAt === at ? job.result : null;
    byId("tried").replaceChildren(...(found ? this.triedWords(found) : [trying && running ? "It is being fitted …" : ""]));
  }

  /** What an effect that was tried does to the error, and the way to keep it. */
  triedWords({ effect, ladder }) {
    const [before, after] = [ladder.at(-2), ladder.at(-1)].map((s) => s.heldout ?? s.fit), where = ladder.at(-1).heldout === null ? "the fitted runs" : "runs held out", falls = before - after;
    const says = falls > 0.005 ? `falls from ${rms(before)} to ${rms(after)}` : falls < -0.005 ? `rises from ${rms(before)} to ${rms(after)}` : `stays at ${rms(after)}`;
    return [`With ${this.titleOf(effect)}, the error on ${where} ${says} times the noise. `, h("button", { type: "button", "data-add": effect, onclick: () => this.job("add", { effect }) }, "keep it in the model")];
  }

  async poll() {
    const job = await tried(() => ask("job"));
    if (job?.state === "running" || !job) return this.showJob(job ?? this.state.job);
    await this.take(() => ask("state"));
  }

  /** What the last diagnosis says, beside the button that made it, with what can be done about it. */
  showOutcome() {
    const { outcome, report } = this.state, box = byId("outcome"), done = outcome && report && this.state.job?.state !== "running";
    box.hidden = !done;
    if (!done) return;
    const inModel = this.state.history.steps.slice(0, this.state.history.at + 1).map((s) => s.label), add = outcome.effects.filter((e) => !inModel.includes(`+ ${e}`));
    box.replaceChildren(
      outcome.fresh ? "" : h("p", { id: "old-report", class: "plea" }, "This verdict and its report are from before the last change. Diagnose again for what is missing now."),
      h("h3", {}, outcome.sentence),
      h("div", { class: "cards" }, outcome.cards.map((c) => h("section", { class: "card" }, h("h4", {}, c.head), h("p", { class: "lead" }, c.lead), c.lines.map((l) => h("p", {}, symbols(l)))))),
      h("p", { class: "tools wide-tools" }, add.map((e) => h("button", { type: "button", class: "step", "aria-pressed": "true", "data-add": e, onclick: () => this.job("add", { effect: e }) }, `add it: ${this.titleOf(e)}`)),
        h("a", { class: "button", id: "report", href: `${this.here}/report?${report}`, target: "_blank", rel: "noopener" }, "open the report, in which the model runs ↗")));
    this.enable();
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
    this.showOutcome();
    byId("name").textContent = state.campaign.campaign?.name ?? "";
  }

  job(kind, more = {}) {
    return this.take(() => send("POST", "jobs", { kind, ...more }));
  }

  /** Take the files of a run out, one after the other. */
  async remove(files) {
    for (const file of files) if (!(await this.take(() => ask(`files/${file}`, { method: "DELETE" })))) return;
  }

  /** Hand out a file that the server may have to make first. */
  async export(name, making) {
    const button = document.activeElement;
    byId("taken").textContent = making;
    button.disabled = true;
    const done = await tried(async () => {
      const response = await fetch(`${await place}/export/${name}`, { headers: { "x-workbench": "1" } });
      if (!response.ok) throw new Refused((await response.json()).error);
      return response.blob();
    });
    button.disabled = false;
    if (done) save(name, done);
    byId("taken").textContent = done ? `${name} was handed out, ${Math.max(1, Math.round(done.size / 1000))} kB.` : "";
  }

  listen() {
    const drop = byId("drop"), sizes = () => Object.fromEntries(Object.keys(SIZES).map((n) => [n, sizeField(n).valueAsNumber]).filter(([, v]) => Number.isFinite(v)));
    byId("sample").addEventListener("click", () => this.take(() => send("POST", "sample", {})));
    byId("import").addEventListener("click", () => this.job("import", sizes()));
    for (const [id, name, making] of [["fmu", "Wheelchair.fmu", "The FMU is being compiled, for a minute or less …"], ["variant", "variant.toml", ""], ["ssv", "parameters.ssv", ""], ["report", "report.html", ""]])
      byId(`export-${id}`).addEventListener("click", () => this.export(name, making));
    for (const id of ["files", "folder"]) byId(id).addEventListener("change", ({ target }) => this.upload([...target.files].map((f) => [f.webkitRelativePath || f.name, f])));
    drop.addEventListener("dragover", (event) => { event.preventDefault(); drop.classList.add("over"); });
    drop.addEventListener("dragleave", () => drop.classList.remove("over"));
    drop.addEventListener("drop", async (event) => { event.preventDefault(); drop.classList.remove("over"); this.upload(await dropped(event.dataTransfer)); });
    byId("calibrate").addEventListener("click", () => this.job("calibrate"));
    byId("diagnose").addEventListener("click", () => this.job("diagnose"));
    byId("add").addEventListener("click", () => this.job("add", { effect: byId("effect").value }));
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
      byId("tried").replaceChildren();
      if (!(await this.take(() => send("POST", "effects", content)))) return;
      byId("effect").value = content.id;
      if (this.ready) this.job("try", { effect: content.id });
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

const sizeField = (name) => byId("lab").querySelector(`[name=${name}]`);
const when = (seconds) => new Date(1000 * seconds).toLocaleString([], { month: "short", day: "numeric", hour: "2-digit", minute: "2-digit" });
const whole = (seconds) => (seconds < 90 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} min`);

/** Faults by their cause: what is wrong alike in many places is said once, with the places behind it. */
const causes = (faults) => h("ul", {}, [...byCause(faults)].map(([what, { fault, places }]) => h("li", { "data-severity": fault.severity }, places.length === 1 ? fault.text
  : h("details", {}, h("summary", {}, h("b", {}, `in ${places.length} places: `), what), h("small", {}, places.join("; "))))));

/** {what is wrong: {fault, places}} */
function byCause(faults) {
  const found = new Map();
  for (const fault of faults) {
    const { where, what } = fault.text.match(PLACE)?.groups ?? { where: "", what: fault.text };
    if (!found.has(what)) found.set(what, { fault, places: [] });
    found.get(what).places.push(where);
  }
  return found;
}

/** The error as it came down, with what each figure is of. */
function fall(ladder) {
  const held = ladder.every((s) => s.heldout !== null), told = (s) => rms(held ? s.heldout : s.fit), [first, ...more] = ladder;
  const steps = more.map((s, i) => `${s.step === "calibrated" ? "calibrated " : i === more.length - 1 ? "now " : ""}${told(s)}`);
  return `error on ${held ? "runs held out" : "fitted runs"}: as given ${told(first)}${steps.length ? ` → ${steps.join(" → ")}` : ""}; 1.00 is noise alone`;
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

const bench = new Workbench();
bench.open();
window.workbench = bench;
