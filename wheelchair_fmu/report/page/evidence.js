// The evidence table, ties and the next experiment, from the diagnosis.

import { byId, csv, h, save } from "page/dom";
import { inUnit, probability, rms, significant, withError } from "page/numbers";

const FIRST = 8; // effects that are open without asking
const SEEN = 0.05; // a probability below which the data show something like the effect
const VERDICTS = {
  missing: "missing", tie: "tied", small: "too small to matter", "not needed": "not needed", cannot_see: "could not be seen",
};

export function evidence(campaign) {
  const { diagnosis, effects } = campaign, records = new Map(effects.map((e) => [e.id, e]));
  byId("evidence").append(table(diagnosis.ranking.filter((r) => records.has(r.effect)), records, campaign.name));
  ties(byId("ties"), diagnosis, records);
}

function table(ranking, records, name) {
  const heads = [["Effect"], ["Estimate ± SE"], ["Of interest from"], ["Corrected p", 1], ["Power", 1], ["Hidden in the fit", 1],
    ["Held out, before → after", 1], ["Rivals"], ["Verdict"]];
  const body = h("tbody", {}, ranking.map((row, i) => line(row, records.get(row.effect), i >= FIRST)));
  const more = h("button", { type: "button", class: "quiet", "aria-expanded": "false" }, `show all ${ranking.length} effects`);
  more.addEventListener("click", () => {
    const open = body.classList.toggle("all");
    more.setAttribute("aria-expanded", open);
    more.textContent = open ? "show the likeliest" : `show all ${ranking.length} effects`;
  });
  return h("div", {}, h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Evidence table" },
    h("table", { class: "evidence" }, h("caption", {}, "Every effect of the catalogue, the likeliest first"),
      h("thead", {}, h("tr", {}, heads.map(([text, right]) => h("th", { scope: "col", class: right ? "number" : null }, text)))), body)),
    h("p", { class: "tools" }, ranking.length > FIRST ? more : null,
      h("button", { type: "button", class: "quiet", onclick: () => save(`${name}-evidence.csv`, csv(columns(ranking))) }, "CSV")));
}

function line(row, record, later) {
  const parameters = record.parameters.map((p) => [p, row.parameters[p.name.split(".").at(-1)]]).filter(([, v]) => v);
  const several = parameters.length > 1;
  const own = (text, p) => h("div", {}, several ? h("span", { class: "parameter" }, p.name.split(".").at(-1), " ") : null, text);
  const fall = row.heldout_after === null ? "–" : `${rms(row.heldout_before)} → ${rms(row.heldout_after)}`;
  return h("tr", { class: later ? "later" : null, "data-verdict": row.verdict },
    h("th", { scope: "row" }, row.effect.replaceAll("_", " "), h("small", {}, record.title)),
    h("td", { "data-head": "Estimate ± SE" }, parameters.map(([p, v]) => own(withError(v.estimate, v.se, p), p))),
    h("td", { "data-head": "Of interest from" }, parameters.map(([p]) => own(inUnit(p.delta, p, 2), p))),
    h("td", { class: "number", "data-head": "Corrected p" }, probability(row.p)),
    h("td", { class: "number", "data-head": "Power" }, row.power.toFixed(2)),
    h("td", { class: "number", "data-head": "Hidden in the fit" }, `${(100 * row.hidden_in_fit).toFixed(row.hidden_in_fit < 0.01 ? 1 : 0)} %`),
    h("td", { class: "number", "data-head": "Held out" }, fall),
    h("td", { "data-head": "Rivals" }, row.rivals.length ? row.rivals.slice(0, 3).map((r) => h("div", {}, `${r.effect.replaceAll("_", " ")} `, h("span", { class: "faint" }, r.cosine.toFixed(2)))) : "–"),
    h("td", { "data-head": "Verdict" }, h("span", { class: "chip", "data-verdict": row.verdict }, row.verdict === "cannot_see" && row.p < SEEN ? "seen, not chosen" : VERDICTS[row.verdict] ?? row.verdict)));
}

function columns(ranking) {
  const out = { effect: [], parameter: [], estimate: [], se: [], unit: [], smallest_interesting: [], p: [], power: [],
    hidden_in_fit: [], heldout_before: [], heldout_after: [], rivals: [], verdict: [] };
  for (const row of ranking)
    for (const [parameter, v] of Object.entries(row.parameters)) {
      const all = { ...row, ...v, parameter, rivals: row.rivals.map((r) => `${r.effect} ${r.cosine}`).join("; ") };
      for (const name of Object.keys(out)) out[name].push(all[name]);
    }
  return out;
}

function ties(section, diagnosis, records) {
  const named = (id) => h("b", {}, id.replaceAll("_", " "));
  for (const group of diagnosis.ties)
    section.append(h("p", {}, "These explain the campaign equally well: ", group.flatMap((id, i) => [i ? ", " : "", named(id)]), "."));
  if (!diagnosis.ties.length) section.append(h("p", {}, diagnosis.effects.length ? "These runs tell what was found from every other effect in the catalogue." : "No effect was found, so none is tied."));
  const next = diagnosis.next_experiment;
  if (next) {
    const times = next.repeats === 1 ? "once" : `${next.repeats} times`;
    section.append(h("p", { class: "next" }, h("b", {}, `Measure next, ${times}: `), `${next.manoeuvre}. `,
      `It tells apart ${next.separates.map((id) => id.replaceAll("_", " ")).join(" and ")}: ${next.why}.`));
  }
  const left = diagnosis.leftover;
  if (left?.where) {
    const { run, channel, rms: size } = left.where;
    section.append(h("p", {}, left.proposal ? `Something structured is left that no effect of the catalogue explains (p ${probability(left.p)}).` :
      `A search for anything else that is left, among generic forces and errors, found nothing that stands (p ${probability(left.p)}).`,
      ` The largest error that remains is ${significant(size, 3)} standard deviations, in ${channel.replaceAll("_", " ")} of ${run}.`));
  }
}
