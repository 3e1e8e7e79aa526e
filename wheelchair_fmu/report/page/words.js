// Names as a reader meets them: no code names outside of commands.

const STEPS = { nominal: "as given", calibrated: "calibrated", "unrecorded forces": "with unrecorded forces" };

/** What an effect is. */
export const titleOf = (campaign, id) => campaign.effects.find((e) => e.id === id)?.title ?? id.replaceAll("_", " ");

/** A step of the search; of what is tied, whichever of these was put in. */
export function stepOf(campaign, step) {
  if (step in STEPS) return STEPS[step];
  if (!step.startsWith("+")) return step.replaceAll("_", " ");
  const { ladder, ties } = campaign.diagnosis, id = step.slice(1), tied = ties.find((group) => group.includes(id));
  return `${ladder.find((s) => s.step.startsWith("+")).step === step ? "with" : "and"} ${titleOf(campaign, id)}${tied ? `, or ${tied.length > 2 ? "a" : "its"} rival` : ""}`;
}

/** What the ranking has of a parameter of an effect, which is of the last model if that has it. */
export function rankedOf({ diagnosis }, name) {
  const [, effect, short] = name.split(".");
  return diagnosis.ranking.find((r) => r.effect === effect)?.parameters[short];
}

/** A term that the search proposes where no effect suffices, as a row of the ranking; null where there is none. */
export function proposed({ effects, diagnosis }) {
  const found = diagnosis.leftover?.proposal, record = found && effects.find((e) => e.id === found.term);
  if (!record) return null;
  const at = diagnosis.ladder.findIndex((s) => s.step === `+${found.term}`), error = (s) => s?.heldout ?? null;
  return { effect: found.term, parameters: { q: { estimate: found.estimate, se: found.se } }, probability: null, power: null, hidden_in_fit: null, p: found.p ?? 0, rivals: [], verdict: "proposed",
    heldout_before: error(diagnosis.ladder[at - 1]), heldout_after: error(diagnosis.ladder[at]) };
}

/** The same in a list of several, where what was put in before is still in. */
export const stillOf = (name) => (name.startsWith("and ") ? `with ${name.slice(4)} as well` : name);

/** The last part of a parameter's name in words; a symbol with an index stays one. */
export function shortOf(name) {
  const own = name.split(".").at(-1);
  return /^\p{L}_[\p{L}\d]+$/u.test(own) ? own : own.replaceAll("_", " ");
}

/** A sentence from its first letter on; one that begins with a name or a unit, as yaw_rate or m/s2, keeps that as it is. */
export const capital = (words) => (/^(?:\S*[\d_./]\S|(?:rad|deg|turn|kg|mg|mm|cm|ms|us|ns|[gms])(?![a-z]))/.test(words) ? words : words.slice(0, 1).toUpperCase() + words.slice(1));
export const channelOf = (name) => name.replace(/^wheel_(speed|angle)_([lr])$/, (_, what, side) => `${side === "l" ? "left" : "right"} wheel ${what}`).replace(/^a_x$/, "forward acceleration").replace(/^a_y$/, "sideways acceleration").replace(/^([xy])$/, "position along $1").replace(/^yaw$/, "heading").replaceAll("_", " ");

/** A name in a sentence: one that is written from right to left leaves the order of the words about it as it is. */
export const isolated = (name) => (/[\p{Script=Arabic}\p{Script=Hebrew}\p{Script=Syriac}\p{Script=Thaana}]/u.test(name) ? `\u2068${name}\u2069` : name);
const BEARERS = { tyre: "tyres", caster: "casters", wheel: "rear wheels", equations: "equations" };

/** What a law is for, as the thing that has it. */
export const bearer = (kind) => BEARERS[kind] ?? kind;

/** "tyres linear (…); casters ideal (…)" of laws [{of, name, says}]. */
export const lawsOf = (laws) => laws.map(({ of, name, says }) => `${bearer(of)} ${name.replaceAll("_", " ")} (${says})`).join("; ");
export const runOf = (run) => (run.role === "holdout" ? `${isolated(run.name)} (held out)` : isolated(run.name));

/** "a, b and c" */
export const listed = (names, word = "and") => (names.length > 1 ? `${names.slice(0, -1).join(", ")} ${word} ${names.at(-1)}` : names.join(""));
