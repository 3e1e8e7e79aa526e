// What the reader sets: steps of the search, effects with their sizes, calibrated values.

import { h, symbols, write } from "page/dom";
import { decimal, display, inUnit, settled, significant, unitText } from "page/numbers";
import { capital, stepOf } from "page/words";

const STEPS = 400; // of a slider

export class Controls {
  /** `changed(values)` hears every change, `fit(values, effects)` that sizes are to be fitted together, of which those of these
   *  effects may be far off. */
  constructor(form, campaign, values, changed, fit) {
    Object.assign(this, { form, campaign, changed, fit });
    this.models = campaign.diagnosis.models;
    this.values = { ...(values ?? this.start().values) };
    this.stored = this.known();
    form.addEventListener("submit", (event) => event.preventDefault());
    this.build();
    this.follow();
  }

  /** Where the page opens: where the search began, so that the reader sees the error fall. */
  start() {
    return this.models.find((m) => m.step === this.campaign.diagnosis.begins);
  }

  /** Fitted values by the effects that are in them: of steps of the search, and of effects that were refitted alone. */
  known() {
    const found = new Map();
    for (const values of [...this.campaign.diagnosis.ranking.map((r) => r.values), ...this.models.filter((m) => m.step !== "nominal").map((m) => m.values)]) if (values) found.set(key(values), values);
    return found;
  }

  build() {
    const rows = new Map(this.campaign.diagnosis.ranking.map((r) => [r.effect, r]));
    for (const e of this.campaign.effects) if (!rows.has(e.id) && this.proposed(e)) rows.set(e.id, this.proposed(e));
    const order = [...rows.keys()].map((id) => this.campaign.effects.find((e) => e.id === id)).filter(Boolean);
    const likely = order.filter((e) => rows.get(e.id).values), others = order.filter((e) => !rows.get(e.id).values);
    this.boxes = new Map();
    this.shown = new Map(); // what every slider stands at
    this.sliders = new Map();
    this.steps = this.models.map((m) => h("button", { type: "button", class: "step", onclick: () => this.put({ ...m.values }) }, stepOf(this.campaign, m.step)));
    const effects = (list) => list.map((e) => this.effect(e, rows.get(e.id)));
    const first = likely.length ? likely : others.slice(0, 5), rest = likely.length ? others : others.slice(5);
    this.again = h("button", { type: "button", class: "quiet", onclick: () => this.fit(this.values, this.ticked()) }, "fit these sizes together");
    this.form.replaceChildren(
      h("fieldset", {}, h("legend", {}, "Put an effect in"),
        h("p", { class: "hint" }, "Sizes of all that is ticked are fitted together, with the calibrated values."),
        effects(first), this.again,
        rest.length ? h("details", {}, h("summary", {}, `${rest.length} less likely effects`), effects(rest)) : null),
      h("fieldset", {}, h("legend", {}, "Go to a step of the search"), h("div", { class: "steps" }, this.steps)),
      h("fieldset", {}, h("legend", {}, "Calibrated values"),
        h("details", {}, h("summary", {}, "change them"), this.campaign.calibrated.map((p) => this.slider(p, this.reach(p))))),
    );
  }

  /** What stands for a row of the ranking where an effect is in a step of the search but in no ranking: a proposed term. */
  proposed(effect) {
    const values = this.models.map((m) => m.values).find((v) => effect.parameters.some((p) => p.name in v));
    return values && { values, parameters: Object.fromEntries(effect.parameters.map((p) => [p.name.split(".").at(-1), { estimate: values[p.name], se: null }])) };
  }

  effect(effect, row) {
    const box = h("input", { type: "checkbox", id: `effect-${effect.id}`, onchange: () => this.tick(effect, row, box.checked) });
    const sliders = h("div", { class: "sliders" }, effect.parameters.map((p) => this.slider(p, this.reach(p, row), row)));
    this.boxes.set(effect.id, { box, sliders, effect });
    return h("div", { class: "effect" }, h("label", { for: box.id, title: effect.id }, box, h("span", {}, capital(effect.title))), sliders);
  }

  /** How far a slider goes: enough for what was found, within the bounds. */
  reach(p, row) {
    if (!row) {
      const value = Math.abs(this.values[p.name] ?? p.default) || p.delta || 1;
      return [Math.max(p.lower ?? -Infinity, 0), Math.min(p.upper ?? Infinity, 2.5 * value)];
    }
    const found = row.parameters[p.name.split(".").at(-1)];
    const size = Math.max(4 * p.delta, found && seen(found) ? 2 * Math.abs(found.estimate) : 0);
    return [Math.max(p.lower ?? -Infinity, -size), Math.min(p.upper ?? Infinity, size)];
  }

  slider(p, [low, high], row) {
    const { unit, factor } = display(p), id = `slider-${p.name}`;
    const range = h("input", { type: "range", id, min: low * factor, max: high * factor, step: "any", "aria-describedby": `${id}-help` });
    const number = h("input", { type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": `${capital(p.meaning)} [${unitText(unit) || "1"}]`, "data-name": p.name });
    const put = (words) => {
      const value = words.trim() ? decimal(words) / factor : NaN, wrong = amiss(value, p, factor);
      number.setCustomValidity(wrong);
      if (wrong) return this.shown.delete(p.name), number.reportValidity();
      return this.put({ ...this.values, [p.name]: value });
    };
    range.addEventListener("input", () => put(range.value));
    range.addEventListener("keydown", (event) => this.stepped(event, range, (high - low) * factor));
    number.addEventListener("change", () => put(number.value));
    const found = row?.parameters[p.name.split(".").at(-1)], own = found && seen(found) ? found.estimate : null;
    const fitted = () => (row ? own : (this.stored.get(key(this.values)) ?? this.start().values)[p.name]) ?? null; // of a calibrated value, with the effects that are in
    const back = h("button", { type: "button", class: "quiet plain", title: row ? "back to the size that the search fitted" : "back to the fitted size", "aria-label": `back to the fitted size: ${p.meaning}`, onclick: () => this.put({ ...this.values, [p.name]: fitted() }) }, "↺");
    const help = h("small", { id: `${id}-help` }), track = h("div", { class: "track" }, range);
    let last;
    const mark = () => {
      const size = fitted();
      if (size === last) return;
      last = size;
      back.hidden = size === null;
      write(help, [p.delta ? `matters from ${inUnit(p.delta, p, 2)}` : null, size === null ? null : `▲ ${row ? "the search found" : "fitted"} ${inUnit(size, p)}`].filter(Boolean).join("; "));
      track.replaceChildren(range, marks(p, low, high, size));
    };
    mark();
    this.sliders.set(p.name, { range, number, factor, record: p, mark });
    return h("div", { class: "slider" }, h("label", { for: id, title: p.name }, symbols(capital(p.meaning))), track,
      h("span", { class: "value" }, number, h("span", { class: "unit" }, unitText(unit)), back), help);
  }

  /** Arrow keys move by a four-hundredth, with Shift by a fortieth: "any" alone would leave that to the browser. */
  stepped(event, range, span) {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    range.valueAsNumber += (way * span * (event.shiftKey ? 10 : 1)) / STEPS;
    range.dispatchEvent(new Event("input"));
  }

  /** In or out. What the search fitted for just these effects is put in as it is; other sizes are fitted together now. */
  tick(effect, row, on) {
    const values = { ...this.values }, own = `effect.${effect.id}.`; // its constants, where the search adjusted them, come and go with it
    if (!on) for (const name of Object.keys(values)) if (name.startsWith(own)) delete values[name];
    if (on) for (const [name, value] of Object.entries(row.values ?? {})) if (name.startsWith(own)) values[name] = value;
    for (const p of effect.parameters) {
      const found = row.parameters[p.name.split(".").at(-1)], fitted = row.values?.[p.name] ?? (found && seen(found) ? found.estimate : p.delta);
      if (on) values[p.name] = Math.min(Math.max(fitted, p.lower ?? -Infinity), p.upper ?? Infinity) || p.delta;
    }
    const known = key(values) === key(this.start().values) ? this.start().values : this.stored.get(key(values));
    this.put(known ? { ...known } : values);
    if (!known) this.fit(this.values, on ? [effect] : []);
  }

  /** The effects that are in. */
  ticked() {
    return [...this.boxes.values()].filter(({ box }) => box.checked).map(({ effect }) => effect);
  }

  put(values) {
    this.values = values;
    this.follow();
    this.changed(values);
  }

  /** Boxes, sliders and steps show the values. */
  follow() {
    for (const { box, sliders, effect } of this.boxes.values()) {
      box.checked = effect.parameters.some((p) => this.values[p.name]);
      sliders.hidden = !box.checked && document.activeElement?.closest?.(".sliders") !== sliders;
    }
    this.again.disabled = ![...this.boxes.values()].some(({ box }) => box.checked); // not hidden: nothing moves under a pointer that drags
    for (const [name, { range, number, factor, record, mark }] of this.sliders) {
      mark();
      const value = settled(this.values[name] ?? this.campaign.known[name] ?? record.default, record) * factor, active = document.activeElement;
      if (this.shown.get(name) === value && active !== range && active !== number) continue;
      this.shown.set(name, value);
      if (document.activeElement !== range || Math.abs(range.valueAsNumber - value) > 1e-9 * Math.abs(value)) range.value = value;
      if (document.activeElement !== number) number.value = written(value, record.delta * factor);
      range.setAttribute("aria-valuetext", `${significant(value, 4)} ${unitText(display(record).unit)}`);
    }
    this.models.forEach((m, i) => this.steps[i].setAttribute("aria-pressed", same(m.values, this.values)));
  }
}

/** Marks under a slider: the band that is of no interest, zero, and what was fitted. */
function marks(p, low, high, fitted) {
  const at = (v) => `calc(8px + (100% - 16px) * ${Math.min(1, Math.max(0, (v - low) / (high - low))).toFixed(4)})`, inside = (v) => v >= low && v <= high;
  const band = p.delta && p.name.startsWith("effect.") ? h("i", { class: "of-no-interest", style: `left:${at(-p.delta)};right:calc(100% - ${at(p.delta)})` }) : null;
  return h("span", { class: "marks", "aria-hidden": "true" }, band, fitted !== null && fitted !== undefined && inside(fitted) ? h("i", { class: "fitted", style: `left:${at(fitted)}` }, "▲") : null);
}

/** What is wrong with a value, in a sentence; nothing of one that may be. */
function amiss(value, p, factor) {
  if (!Number.isFinite(value)) return "give a number, as in 1.5";
  return value < (p.lower ?? -Infinity) || value > (p.upper ?? Infinity) ? `give a number ${within(p, factor)}` : "";
}

/** Bounds in words, in the unit shown. */
const within = ({ lower, upper }, factor) => [[lower, "from"], [upper, "to"]].filter(([b]) => Number.isFinite(b)).map(([b, word]) => `${word} ${significant(b * factor, 4)}`).join(" ");

/** A value in five digits, but none below a thousandth of the size that matters. */
function written(value, delta) {
  const place = delta > 0 ? Math.min(12, Math.max(0, 3 - Math.floor(Math.log10(delta)))) : 12;
  return Number(Number(value.toPrecision(5)).toFixed(place));
}

const seen = (found) => found.se === null || found.se < 3 * Math.abs(found.estimate);

/** The effects that are on in some values. */
const key = (values) => [...new Set(Object.keys(values).filter((n) => n.startsWith("effect.") && values[n] !== 0).map((n) => n.split(".")[1]))].sort().join(" ");

export function same(a, b) {
  const names = new Set([...Object.keys(a), ...Object.keys(b)]);
  return [...names].every((n) => (a[n] ?? 0) === (b[n] ?? 0));
}
