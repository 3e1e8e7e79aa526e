// What the reader sets: steps of the search, effects with their sizes, calibrated values.

import { h } from "page/dom";
import { display, inUnit, significant, unitText } from "page/numbers";

const STEPS = 400; // of a slider

export class Controls {
  constructor(form, campaign, changed) {
    Object.assign(this, { form, campaign, changed });
    this.models = campaign.diagnosis.models;
    this.values = { ...this.start().values };
    form.addEventListener("submit", (event) => event.preventDefault());
    this.build();
    this.follow();
  }

  /** Where the page opens: where the search began, so that the reader sees the error fall. */
  start() {
    return this.models.find((m) => m.step === this.campaign.diagnosis.begins);
  }

  build() {
    const rows = new Map(this.campaign.diagnosis.ranking.map((r) => [r.effect, r]));
    for (const e of this.campaign.effects) if (!rows.has(e.id) && this.proposed(e)) rows.set(e.id, this.proposed(e));
    const order = [...rows.keys()].map((id) => this.campaign.effects.find((e) => e.id === id)).filter(Boolean);
    const likely = order.filter((e) => rows.get(e.id).values), others = order.filter((e) => !rows.get(e.id).values);
    this.boxes = new Map();
    this.sliders = new Map();
    this.steps = this.models.map((m) => h("button", { type: "button", class: "step", onclick: () => this.put({ ...m.values }) }, m.step.replaceAll("_", " ")));
    const effects = (list) => list.map((e) => this.effect(e, rows.get(e.id)));
    this.form.replaceChildren(
      h("fieldset", {}, h("legend", {}, "Go to a step of the search"), h("div", { class: "steps" }, this.steps)),
      h("fieldset", {}, h("legend", {}, "Put an effect in"),
        h("p", { class: "hint" }, "Ticking puts in the size that was fitted, with the calibrated values fitted along with it."),
        effects(likely.length ? likely : others.slice(0, 5)),
        h("details", {}, h("summary", {}, `${others.length} effects that the search did not refit`), effects(likely.length ? others : others.slice(5)))),
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
    const sliders = h("div", { class: "sliders" }, effect.parameters.map((p) => this.slider(p, this.reach(p, row))));
    this.boxes.set(effect.id, { box, sliders, effect });
    return h("div", { class: "effect" }, h("label", { for: box.id }, box, h("span", {}, h("b", {}, effect.id.replaceAll("_", " ")), h("small", {}, effect.title))), sliders);
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

  slider(p, [low, high]) {
    const { unit, factor } = display(p), id = `slider-${p.name}`, name = p.name.split(".").at(-1);
    const range = h("input", { type: "range", id, min: low * factor, max: high * factor, step: "any", "aria-describedby": `${id}-help` });
    const number = h("input", { type: "number", min: (p.lower ?? -1e300) * factor, max: (p.upper ?? 1e300) * factor, step: "any", "aria-label": `${p.name} [${unit}]` });
    const put = (source) => {
      const value = source.valueAsNumber / factor;
      if (!Number.isFinite(value) || value < (p.lower ?? -Infinity) || value > (p.upper ?? Infinity)) return number.setCustomValidity(`between ${p.lower} and ${p.upper}`);
      number.setCustomValidity("");
      this.put({ ...this.values, [p.name]: value });
    };
    range.addEventListener("input", () => put(range));
    range.addEventListener("keydown", (event) => this.stepped(event, range, (high - low) * factor));
    number.addEventListener("change", () => put(number));
    this.sliders.set(p.name, { range, number, factor, record: p });
    const label = p.name.startsWith("effect.") ? name : p.name;
    const help = p.delta ? `${p.meaning}; of interest from ${inUnit(p.delta, p, 2)}` : p.meaning;
    return h("div", { class: "slider" }, h("label", { for: id }, label, h("small", { id: `${id}-help` }, help)), range,
      h("span", { class: "value" }, number, h("span", { class: "unit" }, unitText(unit))));
  }

  /** Arrow keys move by a four-hundredth, with Shift by a fortieth: "any" alone would leave that to the browser. */
  stepped(event, range, span) {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    range.valueAsNumber += (way * span * (event.shiftKey ? 10 : 1)) / STEPS;
    range.dispatchEvent(new Event("input"));
  }

  /** In: the fitted size, or the smallest interesting one. Out: zero. Calibrated values follow. */
  tick(effect, row, on) {
    const values = { ...this.values }, others = [...this.boxes.values()].filter((b) => b.effect !== effect && b.box.checked);
    for (const p of effect.parameters) {
      const found = row.parameters[p.name.split(".").at(-1)];
      const fitted = row.values?.[p.name] ?? (found && seen(found) ? found.estimate : p.delta);
      values[p.name] = on ? Math.min(Math.max(fitted, p.lower ?? -Infinity), p.upper ?? Infinity) || p.delta : 0;
    }
    if (!others.length) {
      const fitted = (on && row.values) || this.start().values, ofChair = (name) => !name.startsWith("effect.");
      for (const name of Object.keys(values)) if (ofChair(name)) delete values[name];
      for (const [name, value] of Object.entries(fitted)) if (ofChair(name)) values[name] = value;
    }
    this.put(values);
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
    for (const [name, { range, number, factor, record }] of this.sliders) {
      const value = (this.values[name] ?? this.campaign.known[name] ?? record.default) * factor;
      if (document.activeElement !== range || Math.abs(range.valueAsNumber - value) > 1e-9 * Math.abs(value)) range.value = value;
      if (document.activeElement !== number) number.value = Number(value.toPrecision(5));
      range.setAttribute("aria-valuetext", significant(value, 4));
    }
    this.models.forEach((m, i) => this.steps[i].setAttribute("aria-pressed", same(m.values, this.values)));
  }
}

const seen = (found) => found.se === null || found.se < 3 * Math.abs(found.estimate);

function same(a, b) {
  const names = new Set([...Object.keys(a), ...Object.keys(b)]);
  return [...names].every((n) => (a[n] ?? 0) === (b[n] ?? 0));
}
