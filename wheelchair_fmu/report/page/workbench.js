// The workbench: forms over a session that the server keeps. Nothing lives only in this page.

import { byId, h, save, symbols, write } from "page/dom";
import { chair, columns, mark, noise, priors, runs } from "page/forms";
import { decimal, rms, unitText } from "page/numbers";
import { capital, listed } from "page/words";

const POLL = 400; // ms between looks at a running job
const TYPED = 300; // ms without a key after which an expression is checked
const LATEST = 3; // pieces of earlier work that are in sight
const LOST = 2000; // ms between looks where the last one had no answer
const SLOW = 250; // ms after which it is said that an answer is waited for
const STEPS = { import: 4, calibrate: 1, diagnose: 14, add: 5, try: 5 }; // of a usual one, as long as none has been seen; to calibrate also one for each run
const OF_LABS = 90; // steps of a usual diagnosis where several devices recorded, whose floors and clocks are found as well
const LONGER = 2; // times what was said to be left, from which it says nothing more
const FEW_STEPS = 3; // before which nobody can tell how long the rest takes
const GONE = "The workbench does not answer. Is it still running? Start it again by “wheelchair workbench” and open the address that it prints: your work is kept.";
const TYPING = "q is the size that is estimated. A number may have its unit behind it, as in -q * tanh(u / 3 [km/h]).";
const MOSTLY = ["F_x", "F_y", "M_z"]; // what an effect of one's own adds to, as a rule

/** What no file tells of a chair, where campaign.toml has it as it was given. */
const SIZES = {
  mass: (c) => c.chair?.m, person: () => null, radius: (c) => c.wheel?.R, track: (c) => c.chair?.t_r, cm_ahead: (c) => c.chair?.b, caster_track: (c) => c.chair?.t_f,
  caster_trail: (c) => c.effect?.caster_trail?.c, wheel_inertia: (c) => (Number.isFinite(c.effect?.wheel_inertia?.m) && Number.isFinite(c.wheel?.R) ? Number((c.effect.wheel_inertia.m * c.wheel.R ** 2 / 2).toFixed(6)) : undefined),
  wheelbase: (c) => (Number.isFinite(c.chair?.a) && Number.isFinite(c.chair?.b) ? Number((c.chair.a + c.chair.b).toFixed(6)) : undefined),
};
const PLACES = { m: "the mass of chair and rider", t_r: "how far the rear wheels are apart", a: "how far the casters' pivots are ahead of the centre of mass", b: "how far the rear axle is behind it", t_f: "how far the casters' pivots are apart" };

const TIMES = { kg: { kg: 1, g: 0.001, lb: 0.45359237 }, m: { m: 1, cm: 0.01, mm: 0.001, in: 0.0254 }, "kg m²": { "kg m²": 1, "kg m2": 1 } }; // units that a size may have behind it

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

const told = byId("error");
let touched = null; // what the reader last used
for (const kind of ["click", "change", "drop"]) document.addEventListener(kind, ({ target }) => { touched = target; }, true);

/** What goes wrong is said beside what was used, and stands until something goes right. */
async function tried(act) {
  try {
    const result = await act();
    told.hidden = true;
    return result;
  } catch (error) {
    const lost = !(error instanceof Refused), near = lost ? null : touched?.closest?.("main p, #drop, main .grid, #forms > details, main table");
    if (lost) byId("dock").prepend(told);
    else if (near) (near.closest(".wide") ?? near).after(told);
    byId("dock").hidden &&= !lost;
    write(told, lost ? GONE : capital(error.message));
    told.hidden = false;
    told.scrollIntoView({ block: "nearest" });
    return null;
  }
}

class Workbench {
  before = Promise.resolve();
  saving = 0; // changes of forms that are on their way
  waits = new Set(); // {words, began}: what is waited for

  async open() {
    this.listen();
    await this.take(() => ask("state"));
  }

  /** Another law for the model at hand. */
  async law(of, name) {
    if (!(await this.take(() => send("POST", "laws", { of, name })))) this.showForms(); // refused: the law is what it was
  }

  /** Ask the server for something that answers with the new state, and show it all. One after the other: an answer that was
   *  overtaken on its way would show an older state over a newer one. */
  take(act, doing = "Looking at the recordings …") {
    let waits = null;
    const late = setTimeout(() => { waits = this.waiting(doing); }, SLOW);
    return this.queued(() => this.taken(act), () => { clearTimeout(late); waits?.ended(); });
  }

  /** Do something once all that was asked before is done, and then what `ends` it. */
  queued(act, ends) {
    const mine = this.before.then(act).finally(ends);
    this.before = mine.catch(() => null);
    return mine;
  }

  /** That an answer is waited for, where it is not there at once, until that has `ended`; `tell` says for how long. */
  waiting(words) {
    const one = { words, began: Date.now() };
    this.waits.add(one);
    const tell = () => { document.body.toggleAttribute("aria-busy", this.waits.size > 0); if (this.state) this.showDock(this.state.job); };
    tell();
    return { tell, ended: () => { this.waits.delete(one); tell(); } };
  }

  async taken(act) {
    const state = await tried(act);
    this.here = location.pathname.replace(/\/$/, "");
    if (state) this.show(state);
    return state;
  }

  show(state) {
    this.state = state;
    byId("loading").hidden = true;
    write(byId("remark"), state.remark ?? "");
    byId("name").textContent = state.files.length ? state.campaign?.campaign?.name ?? "" : "";
    this.showForms();
    this.showFaults();
    this.showHistory();
    this.showEffects();
    this.showJob(state.job);
    this.showOutcome();
    const earlier = state.earlier.map((s) => h("a", { class: "button", href: `/s/${s.id}` }, `${s.name}, ${when(s.at)}`)), older = earlier.splice(LATEST);
    byId("earlier").replaceChildren(...(earlier.length ? ["Earlier work: ", ...earlier] : []), older.length ? h("details", {}, h("summary", {}, `${older.length} older`), h("span", { class: "tools wide-tools" }, older)) : "");
  }

  /** Forms anew; what the reader opened or closed stays so, unless something else is to be seen now. */
  showForms() {
    const { campaign, files } = this.state, before = new Map([...byId("forms").children].map((d) => [d.dataset.form, d]));
    const forms = campaign && files.length ? Object.entries({ runs, columns, noise, chair, priors }).map(([name, of]) => [name, of(this)]) : [];
    for (const [name, form] of forms) {
      const was = before.get(name);
      Object.assign(form.dataset, { form: name, first: form.open });
      if (was?.dataset.first === form.dataset.first) form.open = was.open;
      else if (was?.open && (was.contains(document.activeElement) || was.contains(touched))) form.open = true; // somebody is in it
    }
    byId("forms").replaceChildren(...forms.map(([, form]) => form));
  }

  /** The same about a field that somebody is in, who is not disturbed while typing. */
  showFormsAbout(field) {
    const inside = byId("forms").contains(field), label = inside && field.getAttribute("aria-label");
    if (inside && field.matches("input") && field.value !== field.defaultValue) return;
    const opened = [...byId("forms").querySelectorAll("details details")].map((d) => d.open);
    this.showForms();
    [...byId("forms").querySelectorAll("details details")].forEach((d, i) => { d.open = opened[i] ?? d.open; });
    if (label) [...byId("forms").querySelectorAll("[aria-label]")].find((e) => e.getAttribute("aria-label") === label)?.focus({ preventScroll: true });
  }

  /** Are these files as loggers write them, of which no column is known but for the time? */
  get unread() {
    const { campaign, headers, channels } = this.state, known = new Set(channels.map((c) => c.name).filter((name) => name !== "time"));
    return Boolean(campaign) && Object.keys(headers).length > 0 && !Array.isArray(campaign.recording) && !Object.keys(campaign.columns ?? {}).some((name) => known.has(name)) && !Object.keys(headers).some((header) => known.has(header.replace(/\s*\[.*\]\s*$/, "")));
  }

  /** What there is to do while nobody has said what the columns are. */
  unknown(errors, kinds) {
    const toggled = ({ target }) => { this.byHand = target.open; byId("forms").hidden = !target.open; };
    return [h("p", {}, h("b", {}, "Which column is what is not known yet. "), "Say above what your protocol says of the chair, as far as it does, and press “find out”."),
      h("details", { open: this.byHand, ontoggle: toggled }, h("summary", {}, `or say it by hand: ${kinds} ${kinds > 1 ? "faults" : "fault"} to mend`), causes(errors))];
  }

  /** What stops nothing; open where something of it is to be looked at, until the reader closes it. */
  remarks(remarks, guesses) {
    const doubted = guesses > 0 || remarks.some((f) => f.severity === "warning" && f.column), toggled = ({ target }) => { this.reading = target.open; };
    const guessed = guesses ? `, of which ${guesses} to look at: what a file did not say was guessed` : "";
    return h("details", { open: this.reading ?? doubted, ontoggle: toggled }, h("summary", {}, `${remarks.length} remark${remarks.length > 1 ? "s" : ""}${guessed}`), causes(remarks));
  }

  showFaults() {
    const { faults, files, campaign, job } = this.state, errors = faults.filter((f) => f.severity === "error");
    const guesses = faults.filter((f) => f.severity === "guess").length;
    const remarks = faults.filter((f) => f.severity !== "error").sort((a, b) => (b.severity === "guess") - (a.severity === "guess"));
    const kinds = byCause(errors).size, raw = !Array.isArray(campaign?.recording), unread = files.length > 0 && errors.length > 0 && this.unread;
    // To read files anew mends no value that somebody typed.
    const anew = errors.length > 0 && (!raw || unread || errors.some((f) => f.column || f.what.includes("Columns and their units")));
    const read = job?.kind === "import" && job.state === "done";
    const by = raw && anew && !read ? ": find out above what is in these files, or mend them by hand." : ".";
    const tally = !files.length && !errors.length ? "" : errors.length ? `${kinds} ${kinds > 1 ? "faults" : "fault"} to mend before anything can be concluded${by}` : "These recordings can be read.";
    if (unread) byId("faults").replaceChildren(...this.unknown(errors, kinds));
    else byId("faults").replaceChildren(h("p", {}, h("b", {}, tally)), causes(errors), remarks.length ? this.remarks(remarks, guesses) : "");
    byId("forms").hidden = unread && !this.byHand;
    mark(faults);
    byId("there").hidden = !files.length;
    byId("there").textContent = `${files.length} ${files.length > 1 ? "files are" : "file is"} here; more can be added.`;
    byId("lab").hidden = !files.length || (!anew && raw);
    byId("lab").firstElementChild.textContent = raw ? "What is in these files?" : "Read the files again, with other sizes";
    if (this.asked !== (this.asked = anew)) byId("lab").open = this.asked; // else as the reader left it
    for (const [name, of] of Object.entries(SIZES)) follow(sizeField(name), of(campaign ?? {}));
    sizeField("person").placeholder = campaign?.rider?.m ?? ""; // it may be assumed: who does not give it has it assumed again
    byId("import").setAttribute("aria-pressed", anew);
    byId("sample").hidden = byId("sample-hint").hidden = files.length > 0;
    byId("preview-link").hidden = !files.length || unread;
    byId("preview").href = `${this.here}/preview`;
    this.ready = files.length > 0 && !errors.length;
    const assumed = Object.entries(PLACES).filter(([name]) => campaign?.chair?.[name] === undefined).map(([, words]) => words);
    const placeless = (Array.isArray(campaign?.recording) ? campaign.recording : []).filter((r) => r.at === undefined && this.state.channels.some((c) => c.placed && c.name in (r.columns ?? {}) && !campaign.sensor?.[c.name])).map((r) => r.device);
    byId("assumed").hidden = !this.ready || (!assumed.length && !placeless.length);
    byId("assumed").textContent = [assumed.length ? `Not given, and so taken from another chair: ${listed(assumed)}. Measure it and write it above under “What is known of the chair”.` : "",
      placeless.length ? `Where ${listed(placeless)} ${placeless.length > 1 ? "sit" : "sits"} was not given, and so counts as at the centre of mass: write it above under “Columns and their units”.` : "", "A wrong value there passes for an effect, or hides one."].filter(Boolean).join(" ");
    this.enable();
  }

  enable() {
    const busy = this.state.job?.state === "running", { at, steps } = this.state.history;
    for (const id of ["calibrate", "diagnose", "add"]) byId(id).disabled = busy || !this.ready;
    byId("add").disabled ||= !byId("effect").value;
    write(byId("why"), this.ready ? "" : this.state.files.length ? (this.unread ? "This can begin once it is known which column is what." : "This can begin once nothing is left to mend above.") : "This can begin once there are recordings.");
    for (const id of ["import", "sample"]) byId(id).disabled = busy;
    for (const select of document.querySelectorAll(".laws select")) select.disabled = busy;
    for (const b of document.querySelectorAll("[data-add], [data-again]")) b.disabled = busy || !this.ready;
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
    return step.label.startsWith("+ ") ? `with ${this.titleOf(step.label.slice(2))}` : step.label;
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
    write(byId("export-why"), !this.state.report ? "A report can be taken away after a diagnosis." : this.state.outcome?.fresh ? "" : "The report is of the model before the last change; diagnose again for one of this model.");
  }

  /** The likeliest effects of the last diagnosis come first. */
  showEffects() {
    const { effects, words, outcome } = this.state, select = byId("effect"), order = new Map((outcome?.order ?? []).map((id, i) => [id, i]));
    const there = new Set(this.state.history.steps.slice(0, this.state.history.at + 1).map((s) => s.label)), all = effects.filter((e) => !there.has(`+ ${e.id}`)).sort((a, b) => (order.get(a.id) ?? 1e9) - (order.get(b.id) ?? 1e9));
    select.replaceChildren(...(order.size ? [] : [h("option", { value: "" }, "choose one, or diagnose first")]), ...all.map((e) => h("option", { value: e.id }, `${capital(e.title)}${e.own ? " (your own)" : ""}`)));
    if (this.ranked !== (this.ranked = (outcome?.order ?? []).join())) this.picked = null;
    if (all.some((e) => e.id === this.picked)) select.value = this.picked;
    if (byId("own").elements.to.options.length) return;
    const group = (label, some) => h("optgroup", { label }, some.map((q) => h("option", { value: q.name }, `${q.name} [${unitText(q.unit) || "1"}] ${q.meaning}`)));
    byId("own").elements.to.append(group("forces and moment on the chair", words.targets.filter((q) => MOSTLY.includes(q.name))), group("any other quantity", words.targets.filter((q) => !MOSTLY.includes(q.name))));
    byId("own").elements.to.value = "F_x";
    this.showWords();
  }

  /** The quantities that a term may name: those that are known before what it acts on. */
  showWords() {
    const { targets, readable } = this.state.words, { order } = targets.find((q) => q.name === byId("own").elements.to.value), known = readable.filter((q) => q.order < order);
    byId("readable").replaceChildren(...known.map((q) => h("option", { value: q.name })));
    byId("words").replaceChildren(...known.map((q) => h("div", {}, h("code", {}, q.name), ` [${unitText(q.unit) || "1"}] ${q.meaning}`)));
  }

  showJob(job) {
    this.state.job = job;
    byId("job").hidden = !job;
    if (job?.state === "running") this.watched = true; // what ended before this page was opened is no news
    if (job) {
      const box = byId("job").querySelector("[role=log]"), low = box.scrollTop + box.clientHeight > box.scrollHeight - 40;
      box.replaceChildren(...job.commands.map((c) => h("div", { class: "command" }, `$ ${c}`)), ...job.lines.map((l) => h("div", {}, l)));
      if (low) box.scrollTop = box.scrollHeight;
      this.showTried(job);
    }
    this.showDock(job);
    this.enable();
    this.refocus();
    clearTimeout(this.polling);
    if (job?.state === "running") this.polling = setTimeout(() => this.poll(), told.parentElement === byId("dock") && !told.hidden ? LOST : POLL);
  }

  /** What is going on, always in sight; what came of it, until it is put away. */
  showDock(job) {
    const running = job?.state === "running", [doing] = running ? [] : [...this.waits].slice(-1), waits = Boolean(doing), news = job && !running && (this.watched || job.state === "failed") && this.away !== ended(job);
    const dock = byId("dock"), [bar, words] = byId("progress").children, kept = !told.hidden && told.parentElement === dock;
    dock.hidden = !running && !waits && !news && !kept;
    dock.dataset.state = running || waits ? "running" : job?.state ?? "";
    bar.hidden = kept || (!running && !waits);
    bar.removeAttribute("value");
    write(words, kept ? "" : running ? this.progressed(job, bar) : waits ? spent(doing) : news ? this.came(job) : "");
    byId("cancel").hidden = !running;
    byId("shut").hidden = running || waits;
    const mend = job?.kind === "import" && this.state.faults.some((f) => f.severity === "error"), to = news && job.state === "done" ? (mend ? TO_MEND : SEE[job.kind]) : null;
    byId("see").hidden = !to;
    if (to) [byId("see").href, byId("see").textContent] = to;
    write(byId("said"), running ? this.plain(job.lines.at(-1) ?? "starting") : waits ? doing.words : words.textContent);
    document.title = [running ? `${capital(job.kind)} …` : "", byId("name").textContent, "wheelchair workbench"].filter(Boolean).join(" – ");
  }

  /** Which step it is, of how many, and how long the rest takes: as the last one of its kind did, or else as its steps so far. */
  progressed({ kind, lines, steps, seconds, usual }, bar) {
    const several = Array.isArray(this.state.campaign?.recording), first = kind === "diagnose" && several ? OF_LABS : STEPS[kind] + (kind === "calibrate" ? this.state.campaign.run.length : 0);
    const many = usual?.steps ?? first, length = usual?.seconds ?? (steps >= FEW_STEPS ? (seconds * many) / steps : null), late = usual?.seconds ? seconds >= usual.seconds : many && steps > many;
    if (usual || (many && steps <= many)) bar.value = Math.min(0.98, usual ? seconds / length : steps / many);
    if (!length || steps <= 1) this.ends = length; // when it is thought to end, which is not put off for every little
    else if (!this.ends || length < this.ends || length - seconds > LONGER * (this.ends - seconds)) this.ends = length;
    const left = this.ends ? this.ends - seconds : 0;
    return [capital(this.plain(lines.at(-1) ?? "starting")), `step ${Math.max(1, steps)}${many && steps <= many ? ` of about ${many}` : ""}`, `${whole(seconds)} so far`,
      late ? usual ? "longer than the last time" : "these recordings take longer than most" : left >= 1 ? `about ${whole(left)} left` : ""].filter(Boolean).join(" · ");
  }

  /** What came of a job, in a sentence. */
  came(job) {
    if (job.state === "cancelled") return "Cancelled; nothing was changed.";
    if (job.state === "failed") return `Failed: ${this.plain(job.lines.at(-1) ?? "nothing was said")}`;
    const { effect, ladder } = job.result ?? {}, took = `in ${whole(job.seconds)}`;
    if (job.kind === "import") return `The files were read together, ${took}.`;
    if (job.kind === "diagnose") return `Diagnosed, ${took}.`;
    if (job.kind === "calibrate") return `Calibrated, ${took}${ladder ? `: ${errorOf(ladder.at(-1))}` : ""}.`;
    return `${job.kind === "add" ? "Added" : "Tried"}: ${this.titleOf(effect)}, ${took}. ${capital(changed(ladder))}${this.state.outcome?.forces ? " Here forces that nobody recorded count as error; the verdict counts them as noise." : ""}`;
  }

  /** What a command says, with effects by their titles. */
  plain(line) {
    const titles = new Map([...Object.entries(this.state.words.terms), ...this.state.effects.map((e) => [e.id, e.title])]);
    return line.replace(/^refitting (?!with )/, "refitting with ").replace(/(\w)\+(?=\w)/g, "$1 and ").replace(/\w+/g, (word) => titles.get(word) ?? word);
  }

  showTried(job) {
    const trying = job.kind === "try", { at } = this.state.history, running = job.state === "running";
    if (trying && running) this.triedAt = at; // what was tried is told of this model alone
    const found = trying && job.state === "done" && this.triedAt === at ? job.result : null;
    byId("tried").replaceChildren(...(found ? this.triedWords(found) : [trying && running ? "It is being fitted …" : ""]));
  }

  /** What an effect that was tried does to the error, how large it comes out, and the way to keep it. */
  triedWords({ effect, ladder, estimates, bounds = [] }) {
    const sizes = Object.entries(estimates ?? {}).filter(([name]) => name.startsWith(`effect.${effect}.`)).map(([name, size]) => `its size ${name.split(".").at(-1)} comes out as ${size}`);
    return [`With ${this.titleOf(effect)}, ${changed(ladder)} ${sizes.length ? `${capital(listed(sizes))}. ` : ""}${bounds.map((words) => `Its size ${words} `).join("")}`, h("button", { type: "button", "data-add": effect, onclick: () => this.job("add", { effect }) }, "keep it in the model")];
  }

  async poll() {
    const job = await tried(() => ask("job"));
    if (job?.state === "running" || !job) return this.showJob(job ?? this.state.job);
    this.watched = true;
    await this.take(() => ask("state"));
  }

  /** What the last diagnosis says, beside the button that made it, with what can be done about it. */
  showOutcome() {
    const { outcome, report } = this.state, box = byId("outcome"), done = outcome && report && this.state.job?.state !== "running";
    box.hidden = !done;
    if (!done) return;
    const inModel = this.state.history.steps.slice(0, this.state.history.at + 1).map((s) => s.label), add = outcome.effects.filter((e) => !inModel.includes(`+ ${e}`));
    box.replaceChildren(
      outcome.fresh ? "" : h("p", { id: "old-report", class: "plea" }, "This verdict and its report are from before the last change. ", h("button", { type: "button", "data-again": true, onclick: () => this.job("diagnose") }, "diagnose again"), " for what is missing now."),
      h("h3", {}, outcome.sentence),
      h("div", { class: "cards" }, outcome.cards.map((c) => h("section", { class: "card" }, h("h4", {}, c.head), h("p", { class: "lead" }, c.lead), c.lines.map((l) => h("p", {}, symbols(l)))))),
      outcome.notes.length ? h("details", { open: outcome.notes.some((n) => n.includes("left out")) }, h("summary", {}, `${outcome.notes.length} remark${outcome.notes.length > 1 ? "s" : ""} on recordings and values`), h("ul", {}, outcome.notes.map((n) => h("li", {}, symbols(`${capital(n)}.`))))) : "",
      h("p", { class: "tools wide-tools" }, add.map((e) => h("button", { type: "button", class: "step", "aria-pressed": "true", "data-add": e, onclick: () => this.job("add", { effect: e }) }, `add it: ${this.titleOf(e)}`)),
        h("a", { class: "button", id: "report", href: `${this.here}/report?${report}`, target: "_blank", rel: "noopener" }, outcome.fresh ? "open the report, in which the model runs ↗" : "open the report from before ↗")));
    this.enable();
  }

  /** A form changed the campaign: send it, and show what the checks say. One after the other, each change to what those before
   *  it left: who types fast loses nothing. */
  save(change) {
    const said = this.words(touched);
    this.saving += 1;
    return this.queued(() => this.saved(change, said), () => { this.saving -= 1; });
  }

  /** What a field says, in words: "role of run05 = held out". */
  words(field) {
    const label = field?.getAttribute?.("aria-label");
    return label ? `${label.split(": ")[0]} = ${field.selectedOptions?.[0]?.textContent ?? field.value}` : "";
  }

  async saved(change, said) {
    const content = structuredClone(this.state.campaign), remark = change(content);
    const state = await tried(() => send("PUT", `campaign?said=${encodeURIComponent(said)}`, content));
    if (!state) return;
    write(byId("remark"), typeof remark === "string" ? remark : "");
    this.state = { ...state, job: this.state.job };
    if (this.saving === 1) this.showFormsAbout(document.activeElement);
    this.showFaults();
    this.showHistory();
    this.showEffects();
    this.showOutcome();
    byId("name").textContent = state.campaign.campaign?.name ?? "";
  }

  /** Begin a job. It shows at once; where it is refused, all is as it was. */
  async job(kind, more = {}) {
    const was = this.state.job;
    this.away = null;
    this.showJob({ kind, state: "running", lines: [], commands: [], steps: 0, seconds: 0, usual: null, result: null });
    const state = await this.take(() => send("POST", "jobs", { kind, ...more }));
    if (state) return state;
    this.showJob(was);
    const now = async () => { const other = await ask("state").catch(() => null); if (other) this.show(other); };
    await this.queued(now, () => {}); // another window may have begun something
    return null;
  }

  /** Take the files of a run out, one after the other. */
  async remove(files) {
    for (const file of files) if (!(await this.take(() => ask(`files/${file}`, { method: "DELETE" })))) return;
  }

  /** Whoever used what is gone now, or rests, goes on from the head of its section, and not from the top of the page. */
  refocus() {
    const { element, section } = this.used ?? {};
    const { activeElement: active } = document; // Firefox leaves the focus on what is hidden
    if (!section || (active !== document.body && active !== element) || (element.isConnected && !element.disabled && element.getClientRects().length)) return;
    this.used = null;
    const head = section.querySelector("h2");
    head.tabIndex = -1;
    head.focus({ preventScroll: true });
  }

  /** Hand out a file that the server may have to make first. */
  async export(name, making) {
    const button = document.activeElement, waits = making ? this.waiting(making) : null, ticking = making ? setInterval(waits.tell, 1000) : null;
    byId("taken").textContent = "";
    button.disabled = true;
    const done = await tried(async () => {
      const response = await fetch(`${await place}/export/${name}`, { headers: { "x-workbench": "1" } });
      if (!response.ok) throw new Refused((await response.json()).error);
      return response.blob();
    });
    clearInterval(ticking);
    waits?.ended();
    button.disabled = false;
    if (document.activeElement === document.body) button.focus({ preventScroll: true });
    if (done) save(name, done);
    byId("taken").textContent = done ? `${name} was handed out, ${Math.max(1, Math.round(done.size / 1000))} kB.` : "";
  }

  listen() {
    document.addEventListener("focusin", ({ target }) => { this.used = { element: target, section: target.closest("section") }; });
    const drop = byId("drop"), sizes = () => Object.fromEntries(Object.keys(SIZES).map((n) => [n, sizeOf(sizeField(n))]).filter(([, v]) => v !== null));
    byId("sample").addEventListener("click", () => this.take(() => send("POST", "sample", {}), "Taking in the sample …"));
    byId("import").addEventListener("click", () => { if (allSizes()) this.job("import", sizes()); });
    for (const name of Object.keys(SIZES)) sizeField(name).addEventListener("change", ({ target }) => wrongSize(target));
    for (const [id, name, making] of [["fmu", "Wheelchair.fmu", "The FMU is being compiled …"], ["variant", "variant.toml", ""], ["ssv", "parameters.ssv", ""], ["report", "report.html", ""]])
      byId(`export-${id}`).addEventListener("click", () => this.export(name, making));
    for (const id of ["files", "folder"]) byId(id).addEventListener("change", ({ target }) => this.upload([...target.files].map((f) => [f.webkitRelativePath || f.name, f])));
    drop.addEventListener("dragover", (event) => { event.preventDefault(); drop.classList.add("over"); });
    drop.addEventListener("dragleave", () => drop.classList.remove("over"));
    drop.addEventListener("drop", async (event) => { event.preventDefault(); drop.classList.remove("over"); this.upload(await dropped(event.dataTransfer)); });
    byId("calibrate").addEventListener("click", () => this.job("calibrate"));
    byId("diagnose").addEventListener("click", () => this.job("diagnose"));
    byId("effect").addEventListener("change", ({ target }) => { this.picked = target.value; this.enable(); });
    byId("shut").addEventListener("click", () => this.putAway());
    byId("see").addEventListener("click", () => this.putAway());
    document.addEventListener("visibilitychange", () => this.lookAgain());
    byId("add").addEventListener("click", () => this.job("add", { effect: byId("effect").value }));
    byId("cancel").addEventListener("click", () => this.take(() => ask("jobs", { method: "DELETE" })));
    for (const [id, by] of [["undo", -1], ["redo", 1]]) byId(id).addEventListener("click", () => { this.putAway(); this.take(() => send("POST", "history", { by })); });
    this.listenToExpression(byId("own"));
  }

  putAway() {
    this.away = ended(this.state.job);
    if (told.parentElement === byId("dock")) told.hidden = true;
    this.showDock(this.state.job);
  }

  /** Another tab may have changed this work meanwhile. */
  async lookAgain() {
    if (document.visibilityState !== "visible" || !this.state || this.state.job?.state === "running") return;
    const seen = await ask("state").catch(() => null), essence = (s) => JSON.stringify([s.campaign, s.files, s.history, s.report, s.job?.state]);
    if (seen && essence(seen) !== essence(this.state)) await this.take(() => ask("state")); // anew: meanwhile a job may have begun
  }

  listenToExpression(form) {
    const unit = byId("unit");
    unit.textContent = TYPING;
    const check = async () => {
      if (!form.elements.expression.value.trim()) {
        delete unit.dataset.state;
        unit.textContent = TYPING;
        return;
      }
      const found = await tried(() => send("POST", "expression", { expression: form.elements.expression.value, to: form.elements.to.value }));
      if (!found) return;
      unit.dataset.state = found.unit ? "good" : "bad";
      unit.textContent = found.unit ? `The units fit where q is ${unitText(found.unit) ? `in ${unitText(found.unit)}` : "a plain number"}.` : capital(found.why);
      byId("unit-name").textContent = found.unit ? unitText(found.unit) : "";
    };
    const soon = () => { clearTimeout(this.typing); this.typing = setTimeout(check, TYPED); };
    form.elements.expression.addEventListener("input", soon);
    form.elements.to.addEventListener("change", () => { this.showWords(); check(); });
    for (const name of ["size", "lower", "upper"]) form.elements[name].addEventListener("input", ({ target }) => target.setCustomValidity(Number.isFinite(decimal(target.value)) ? "" : "give a number, as in 0.5"));
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      const text = (name) => form.elements[name].value.trim(), number = (name) => decimal(form.elements[name].value);
      const content = { id: text("id"), title: text("title"), to: text("to"), expression: text("expression"), size: number("size"), lower: number("lower"), upper: number("upper") };
      byId("tried").textContent = "It is put into the catalogue …";
      const there = await this.take(() => send("POST", "effects", content), "Putting it into the catalogue …");
      byId("tried").textContent = there && !this.ready ? "It is in the catalogue, and can be tried once there are recordings that can be read." : "";
      if (!there) return;
      if (there.remark) byId("unit").removeAttribute("data-state");
      if (there.remark) byId("unit").textContent = there.remark;
      byId("effect").value = this.picked = content.id;
      if (this.ready) this.job("try", { effect: content.id });
    });
  }

  upload(files) {
    if (!files.length) return null;
    const most = this.state?.most_upload, all = files.reduce((sum, [, file]) => sum + file.size, 0);
    if (all > most) return tried(() => { throw new Refused(`${Math.ceil(all / 1e6)} MB at once is too much for the workbench, which takes ${most / 1e6} MB; add fewer at a time`); });
    const toml = files.find(([path]) => path.endsWith("campaign.toml")), first = toml ?? files[0], count = files.length;
    const base = first[0].slice(0, first[0].lastIndexOf("/") + 1), form = new FormData();
    const sent = files.filter(([, file]) => !file.name.startsWith(".")).map(([path, file]) => [path.startsWith(base) ? path.slice(base.length) : path, file]);
    for (const [path, file] of sent) form.append("files", file, path);
    form.append("paths", JSON.stringify(sent.map(([path]) => path))); // a form writes " of a file's name as %22
    form.append("name", base.split("/").at(-2) ?? "");
    return this.take(() => ask("files", { method: "POST", body: form }), `Taking in ${count} ${count > 1 ? "files" : "file"} …`);
  }
}

/** What is waited for, and for how long where it takes seconds. */
function spent({ words, began }) {
  const seconds = (Date.now() - began) / 1000;
  return seconds < 1 ? words : `${words} ${whole(seconds)} so far`;
}

const sizeField = (name) => byId("lab").querySelector(`[name=${name}]`);

/** A field has what the campaign says, unless the reader has written something else. */
function follow(field, value) {
  const told = String(value ?? "");
  if (!field.value || field.value === field.dataset.told) field.value = told;
  field.dataset.told = told;
}

/** What a field of a size says, null where it is empty; NaN where it is no number. */
function sizeOf(field) {
  const [, number, unit] = field.value.trim().match(/^(.*?)\s*(kg m[2²]|[a-z]*)$/i);
  if (!number && !unit) return null;
  const times = unit ? TIMES[field.dataset.unit][unit.toLowerCase()] ?? NaN : 1;
  return Number((decimal(number) * times).toPrecision(12));
}

/** Say beside a size what is wrong with it; is something? */
function wrongSize(field) {
  const value = sizeOf(field), [least, most] = [field.dataset.least, field.dataset.most].map(Number), unit = field.dataset.unit, place = field.parentElement.querySelector(".wrong") ?? field.parentElement.appendChild(h("small", { class: "wrong" }));
  const bad = value !== null && !(value >= least && value <= most), other = [value / 100, value / 1000].find((v) => unit === "m" && v >= least && v <= most);
  field.setAttribute("aria-invalid", bad);
  place.textContent = bad ? `Give ${least} to ${most} ${unit}${other ? `; is it ${Number(other.toFixed(4))} m?` : "."}` : "";
  return bad;
}

/** Are all sizes such as a chair has? What is wrong is said beside each. */
function allSizes() {
  const bad = Object.keys(SIZES).filter((name) => wrongSize(sizeField(name))), [a, b] = ["wheelbase", "cm_ahead"].map((name) => sizeOf(sizeField(name)));
  if (!bad.length && a !== null && b !== null && b >= a) {
    sizeField("cm_ahead").parentElement.querySelector(".wrong").textContent = "The centre of mass cannot be ahead of the casters’ pivots: measure both from the rear axle.";
    bad.push("cm_ahead");
  }
  if (bad.length) sizeField(bad[0]).focus();
  return !bad.length;
}

const when = (seconds) => new Date(1000 * seconds).toLocaleString([], { month: "short", day: "numeric", hour: "2-digit", minute: "2-digit" });
const whole = (seconds) => (seconds < 120 ? `${Math.round(seconds)} s` : `${Math.floor(seconds / 60)} min ${String(Math.round(seconds % 60)).padStart(2, "0")} s`);

/** Where to look once it has ended: [address, words]. */
const TO_MEND = ["#faults", "see what is to be mended"];
const SEE = { import: ["#measurements-title", "see what is in them"], diagnose: ["#outcome", "read the verdict"], calibrate: ["#history", "see the models"], add: ["#history", "see the models"], try: ["#tried", "see what it does"] };

/** Which end of which job it is, so that it can be put away. */
const ended = (job) => job && `${job.kind} ${job.state} ${job.seconds}`;

/** Faults by their cause: what is wrong alike in many places is said once, with the places behind it. */
const causes = (faults) => h("ul", {}, [...byCause(faults).values()].map(({ fault, fault: { what }, places }) => h("li", { "data-severity": fault.severity }, places.length === 1 ? [capital(what), places[0] ? h("small", {}, places[0]) : null]
  : h("details", {}, h("summary", {}, capital(what), h("small", {}, `in ${places.length} places`)), h("small", {}, places.filter(Boolean).join("; "))))));

/** {what is wrong, but for its numbers: {fault, places}} */
function byCause(faults) {
  const found = new Map();
  for (const fault of faults) {
    const beside = fault.at && document.querySelector(`#forms .wrong[data-at="${CSS.escape(fault.at)}"]`), where = beside ? "" : fault.where; // the form has it
    const cause = fault.what.replace(/(?<![\w.])[-−]?\d+(?:\.\d+)?(?![\w.])/g, "#"), known = found.get(cause);
    if (known) known.places.push([where, fault.what === known.fault.what ? "" : fault.what].filter(Boolean).join(": "));
    else found.set(cause, { fault, places: [where] });
  }
  return found;
}

const onWhich = (held) => `error on ${held ? "runs held out" : "fitted runs"}`;

/** One error of a ladder: "the error on runs held out is 1.01 times the noise". */
const errorOf = (step) => `the ${onWhich(step.heldout !== null)} is ${rms(step.heldout ?? step.fit)} times the noise`;

/** What the last step of a ladder did to the error. */
function changed(ladder) {
  const held = ladder.at(-1).heldout !== null, [before, after] = [ladder.at(-2), ladder.at(-1)].map((s) => (held ? s.heldout : s.fit)), falls = before - after;
  const says = falls > 0.005 ? `falls from ${rms(before)} to ${rms(after)}` : falls < -0.005 ? `rises from ${rms(before)} to ${rms(after)}` : `stays at ${rms(after)}`;
  return `the ${onWhich(held)} ${says} times the noise.`;
}

/** The error as it came down, with what each figure is of. */
function fall(ladder) {
  const held = ladder.every((s) => s.heldout !== null), names = { nominal: "as given ", calibrated: "calibrated " };
  const steps = ladder.map((s, i) => `${names[s.step] ?? (i === ladder.length - 1 ? "now " : "")}${rms(held ? s.heldout : s.fit)}`);
  return `${onWhich(held)}: ${steps.join(" → ")}; 1.00 is noise alone`;
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
