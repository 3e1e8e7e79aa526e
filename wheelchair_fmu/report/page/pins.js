// Variants A, B and C, kept beside what is set now.

import { byId, h } from "page/dom";
import { inUnit, rms } from "page/numbers";
import { listed, shortOf, titleOf } from "page/words";

export const LABELS = ["A", "B", "C"];
const PLAINLY = 3, NAMED = 3; // standard errors from what was fitted, and values that are told

export class Pins {
  /** `pinned(kept)` is called with [{label, values}] when they change, `put(values)` to go to one. */
  constructor(campaign, kept, pinned, put) {
    Object.assign(this, { campaign, kept: kept.map((values, i) => ({ label: LABELS[i], values })), pinned, put });
    this.body = h("tbody");
    this.button = h("button", { type: "button", onclick: () => this.add() }, "keep this as A");
    byId("pins").append(h("div", { class: "pinning" }, this.button, h("span", { class: "faint" }, "to compare up to three settings")),
      this.table = h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Kept settings" }, h("table", { class: "pins" }, h("caption", {}, "Kept beside what is set now"),
        h("thead", {}, h("tr", {}, ["", "held out", "fitted", "with", ""].map((t) => (t ? h("th", { scope: "col" }, t) : h("td"))))), this.body)));
  }

  add() {
    const label = LABELS.find((l) => !this.kept.some((k) => k.label === l));
    if (!label) return;
    this.kept.push({ label, values: { ...this.now.values }, errors: this.now.errors });
    this.kept.sort((a, b) => a.label.localeCompare(b.label));
    this.pinned();
  }

  drop(one) {
    this.kept = this.kept.filter((k) => k !== one);
    this.pinned();
  }

  /** Show the settings with their errors {fit, heldout}; `now` is {values, errors}. */
  show(now) {
    this.now = now;
    const free = LABELS.find((l) => !this.kept.some((k) => k.label === l));
    this.button.textContent = free ? `keep this as ${free}` : "three are kept";
    this.button.disabled = !free;
    this.table.hidden = !this.kept.length;
    const rows = [...this.kept, ...(this.kept.length ? [{ label: "now", ...now }] : [])];
    this.body.replaceChildren(...rows.map((k) => h("tr", {}, h("th", { scope: "row" }, k.label), h("td", {}, rms(k.errors?.heldout)), h("td", {}, rms(k.errors?.fit)), h("td", { class: "long-text" }, this.words(k.values)),
      h("td", {}, k.label === "now" ? null : [h("button", { type: "button", class: "quiet", "aria-label": `go to ${k.label}`, onclick: () => this.put({ ...k.values }) }, "go to"),
        h("button", { type: "button", class: "quiet", "aria-label": `forget ${k.label}`, onclick: () => this.drop(k) }, "✕")]))));
  }

  words(values) {
    const on = this.campaign.effects.filter((e) => e.parameters.some((p) => values[p.name]));
    const effects = listed(on.map((e) => `${titleOf(this.campaign, e.id)} (${e.parameters.map((p) => `${e.parameters.length > 1 ? `${shortOf(p.name)} ` : ""}${inUnit(values[p.name] ?? 0, p)}`).join(", ")})`)) || "no effect";
    return [effects, ...this.elsewhere(values).map((p) => `${p.meaning} ${inUnit(values[p.name], p)}`)].join("; ");
  }

  /** Calibrated values that are plainly not those of any step of the search: the furthest first. */
  elsewhere(values) {
    const { calibrated, diagnosis: { calibration, models } } = this.campaign, fitted = models.filter((m) => m.step !== "nominal");
    const off = (p) => Math.min(...fitted.map((m) => Math.abs(values[p.name] - m.values[p.name]) / (calibration?.[p.name]?.se || Infinity)));
    return calibrated.filter((p) => p.name in values && off(p) > PLAINLY).sort((a, b) => off(b) - off(a)).slice(0, NAMED);
  }
}
