// The evidence table, ties and the next experiment, from the diagnosis.

import { byId, csv, h, save, symbols } from "page/dom";
import { chance, inUnit, rms, significant, uncertain } from "page/numbers";
import { capital, channelOf, isolated, listed, proposed, rankedOf, titleOf } from "page/words";

const FIRST = 8; // effects that are open without asking
const PLAIN = 3; // standard errors from nothing, from which the data show something
const SEEN = 0.05; // a p below which the data show something like an effect that was not chosen
const KEY = `Sizes are of an effect put in alone, or beside what was put in before it. Would be seen: in how many of such campaigns it would show at the
  smallest size that matters. Hidden in the fit: how much of what it does calibrated values can imitate, and where that is most of it by which values. Held out: the error on runs held out,
  noise = 1, before and after it was put in. Alike: effects that do nearly the same to the readings; 1 is just the same.`;
const MOSTLY = 0.5, IMITATORS = 2; // share of an effect from which the values that imitate it are named, and how many of them
const UNCHOSEN = ["cannot_see", "not needed", "small"];
const VERDICTS = {
  missing: "missing", tie: "tied", small: "too small to matter", "not needed": "not needed", cannot_see: "could not be seen", proposed: "helps most; not in the catalogue",
};

export function evidence(campaign) {
  const { diagnosis, effects } = campaign, records = new Map(effects.map((e) => [e.id, e]));
  byId("evidence").append(table([proposed(campaign), ...diagnosis.ranking].filter((r) => r && records.has(r.effect)), records, campaign));
  const groups = (diagnosis.groups ?? []).filter((g) => g.effects.every((e) => records.has(e)));
  if (groups.length) byId("evidence").append(together(groups, campaign));
  ties(byId("ties"), campaign);
}

function table(ranking, records, campaign) {
  const heads = [["Effect"], ["Size"], ["Matters from"], ["Chance that it matters", 1], ["Would be seen", 1], ["Hidden in the fit", 1],
    ["Held out, before → after", 1], ["Alike"], ["Verdict"]];
  const body = h("tbody", {}, ranking.map((row, i) => line(campaign, row, records.get(row.effect), i >= FIRST)));
  const more = h("button", { type: "button", class: "quiet", "aria-expanded": "false" }, `show all ${ranking.length} effects`);
  more.addEventListener("click", () => {
    const open = body.classList.toggle("all");
    more.setAttribute("aria-expanded", open);
    more.textContent = open ? "show the likeliest" : `show all ${ranking.length} effects`;
  });
  return h("div", {}, h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Evidence table" },
    h("table", { class: "evidence" }, h("caption", {}, h("span", { class: "on-screen" }, "Every effect of the catalogue, the likeliest first"), h("span", { class: "on-paper" }, "The likeliest effects of the catalogue")),
      h("thead", {}, h("tr", {}, heads.map(([text, right]) => h("th", { scope: "col", class: right ? "number" : null }, text)))), body)),
    h("p", { class: "hint of-columns" }, KEY),
    h("p", { class: "tools" }, ranking.length > FIRST ? more : null,
      h("button", { type: "button", class: "quiet", onclick: () => save(`${campaign.name}-evidence.csv`, csv(columns(ranking))) }, "CSV")));
}

function line(campaign, row, record, later) {
  const parameters = record.parameters.map((p) => [p, row.parameters[p.name.split(".").at(-1)]]).filter(([, v]) => v);
  const several = parameters.length > 1, outside = campaign.diagnosis.verdict === "outside", chosen = isChosen(row, campaign);
  const own = (text, p) => h("div", {}, several ? h("span", { class: "parameter" }, symbols(p.name.split(".").at(-1)), " ") : null, text);
  const fall = row.heldout_after === null ? "–" : `${rms(row.heldout_before)} → ${rms(row.heldout_after)}`;
  return h("tr", { class: later ? "later" : null, "data-verdict": row.verdict },
    h("th", { scope: "row", title: row.verdict === "proposed" ? null : row.effect }, capital(record.title)),
    h("td", { "data-head": "Size" }, parameters.map(([p, v]) => own(`${uncertain(v, p)}${atBound(v, p) ? ", at its bound" : ""}`, p))),
    h("td", { "data-head": "Matters from" }, parameters.map(([p]) => own(inUnit(p.delta, p, 2), p))),
    h("td", { class: "number", "data-head": "Chance that it matters" }, outside && !chosen ? "–" : chance(row.probability)),
    h("td", { class: "number", "data-head": "Would be seen" }, row.power === null ? "–" : `${Math.round(100 * row.power)} %`),
    h("td", { class: "number", "data-head": "Hidden in the fit" }, hidden(row, parameters)),
    h("td", { class: "number", "data-head": "Held out" }, fall),
    h("td", { "data-head": "Alike" }, row.rivals.length ? row.rivals.slice(0, 3).map((r) => h("div", {}, `${titleOf(campaign, r.effect)} `, h("span", { class: "faint" }, alike(r.cosine)))) : "–"),
    h("td", { "data-head": "Verdict" }, h("span", { class: "chip", "data-verdict": row.verdict }, became(row, parameters, campaign))));
}

/** How much of an effect calibrated values can imitate; where that is most of it, which of them, and in which direction. */
function hidden(row, parameters) {
  if (row.hidden_in_fit === null) return "–";
  const share = `${(100 * row.hidden_in_fit).toFixed(row.hidden_in_fit < 0.01 ? 1 : 0)} %`;
  const made = parameters[0]?.[1].made_up_by?.slice(0, IMITATORS) ?? []; // of its first size, as a cell has little room
  if (row.hidden_in_fit < MOSTLY || !made.length) return share;
  return [share, h("div", { class: "faint imitators" }, made.flatMap(({ name, change }, i) => [i ? ", " : "as ", change > 0 ? "more " : "less ", ...symbols(name.split(".").at(-1))]))];
}

const isChosen = (row, { diagnosis }) => diagnosis.effects.includes(row.effect) || row.verdict === "proposed";

/** What became of an effect, in words. */
function became(row, parameters, campaign) {
  const { diagnosis } = campaign, shows = row.p < SEEN || parameters.some(([, v]) => v.se !== null && Math.abs(v.estimate) > PLAIN * v.se);
  if (row.in_model && row.verdict === "cannot_see") return "helps; how large it is, these runs do not tell";
  if (shows && !isChosen(row, campaign) && UNCHOSEN.includes(row.verdict)) {
    if (parameters.every(([p, v]) => v.se !== null && Math.abs(v.estimate) + 1.96 * v.se < p.delta)) return VERDICTS.small;
    return diagnosis.effects.length || diagnosis.leftover?.proposal ? "another explains it better" : "not chosen";
  }
  if (diagnosis.verdict === "outside" && row.verdict === "missing") return "helps, does not suffice";
  return row.verdict === "not needed" && row.one_form_of ? `${VERDICTS[row.verdict]} in this form` : VERDICTS[row.verdict] ?? row.verdict;
}

/** Does a size stand where a fit may go no further? */
const atBound = (v, p) => [p.lower, p.upper].some((b) => b && Math.abs(v.estimate - b) < 1e-3 * Math.abs(p.delta || b));

/** Effects that were refitted several at once. */
function together(groups, campaign) {
  const sizes = new Map(campaign.effects.flatMap((e) => e.parameters.map((p) => [p.name, p]))), named = (ids) => listed(ids.map((e) => titleOf(campaign, e)));
  const cell = (head, inner) => h("td", { "data-head": head }, inner);
  const rows = groups.map((g) => h("tr", {}, h("th", { scope: "row" }, capital(g.effects.map((e) => titleOf(campaign, e)).join(" with "))),
    cell("Size", Object.entries(g.parameters).map(([n, v]) => h("div", {}, uncertain(g.found ? rankedOf(campaign, n) ?? v : v, sizes.get(n))))),
    cell("Beside", g.beside.length ? named(g.beside) : "–"), cell("Verdict", kept(g, campaign))));
  return h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Effects that were fitted together" },
    h("table", { class: "evidence several" }, h("caption", {}, "Effects that were fitted together, as one acts through the other and each alone may show nothing"),
      h("thead", {}, h("tr", {}, ["Effects", "Size", "Beside", "Verdict"].map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, rows)));
}

/** What was kept of a group. */
function kept(group, campaign) {
  const left = group.found ? group.effects.filter((e) => campaign.diagnosis.effects.includes(e)) : [];
  if (left.length === group.effects.length) return h("span", { class: "chip", "data-verdict": "missing" }, "missing");
  return h("span", { class: "chip" }, left.length ? `${listed(left.map((e) => titleOf(campaign, e)))} suffices` : group.p < SEEN ? "another explains it better" : VERDICTS["not needed"]);
}

function columns(ranking) {
  const out = { effect: [], parameter: [], estimate: [], se: [], interval_low: [], interval_high: [], unit: [], smallest_interesting: [], probability: [], p: [], power: [],
    hidden_in_fit: [], made_up_by: [], heldout_before: [], heldout_after: [], rivals: [], verdict: [] };
  for (const row of ranking)
    for (const [parameter, v] of Object.entries(row.parameters)) {
      const [interval_low, interval_high] = v.interval ?? [];
      const all = { ...row, ...v, interval_low, interval_high, parameter, rivals: row.rivals.map((r) => `${r.effect} ${r.cosine}`).join("; "),
        made_up_by: (v.made_up_by ?? []).map((m) => `${m.name} ${significant(m.change, 3)} ${m.unit}`).join("; ") };
      for (const name of Object.keys(out)) out[name].push(all[name]);
    }
  return out;
}

/** How alike two signatures are: never the same, where it is only so to two digits. */
const alike = (cosine) => (cosine >= 0.995 && cosine < 1 ? cosine.toFixed(4) : cosine.toFixed(2));

function ties(section, campaign) {
  const { diagnosis } = campaign, named = (id) => titleOf(campaign, id);
  for (const group of diagnosis.ties) section.append(h("p", {}, `This campaign cannot tell these apart: ${listed(group.map(named))}.`));
  section.querySelector("h2").textContent = diagnosis.ties.length ? "What cannot be told apart, and what to measure next" : diagnosis.verdict === "outside" ? `What ${diagnosis.next_experiment ? "to measure next, and what is" : "is"} left` : `Rivals, and what ${diagnosis.next_experiment ? "to measure next" : "is left"}`;
  const told = campaign.story.screens.find((s) => s.kind === "rivals").lines;
  if (!diagnosis.ties.length) section.append(...(diagnosis.verdict === "outside" ? [] : diagnosis.effects.length ? told.map((line) => h("p", {}, symbols(line))) : [h("p", {}, "No effect was found, so none is tied.")]));
  const [next, why] = campaign.story.following ?? [];
  if (next) section.append(h("p", { class: "next" }, h("b", {}, symbols(next)), " ", why));
  const left = diagnosis.leftover;
  if (left?.where) {
    const { run, channel, rms: size } = left.where, where = `the ${channelOf(channel)} of ${isolated(run)}, ${significant(size, 3)} times the noise`;
    section.append(h("p", {}, left.proposal ? `Without what helps most, the model errs most in ${where}.` :
      `A search for anything else that is left, among generic forces and errors, found nothing that would be put in. The largest error that is left on the fitted runs is in ${where}.`));
  }
}
