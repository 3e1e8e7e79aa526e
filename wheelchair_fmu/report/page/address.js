// The whole state of the page in its address, so that a view is a link and survives a reload.

const KEYS = ["values", "run", "channel", "t", "from", "to", "screen", "guess", "pins", "theme", "speed", "loop"];

export const write = (state) => `#${encodeURIComponent(JSON.stringify(state))}`;

/** Is this a view of the page, rather than an anchor in it? */
export const isState = (hash) => hash.startsWith("#%7B");

/** What the address says, as far as it fits this campaign; {} of none. */
export function read(hash, campaign, known) {
  let found;
  try {
    found = JSON.parse(decodeURIComponent(hash.slice(1)));
  } catch {
    return {}; // an ordinary anchor, or a link that was cut
  }
  if (found === null || typeof found !== "object") return {};
  const state = Object.fromEntries(KEYS.filter((k) => k in found).map((k) => [k, found[k]])), number = (v) => typeof v === "number" && Number.isFinite(v);
  const values = (v) => v !== null && typeof v === "object" && Object.entries(v).every(([name, x]) => known.has(name) && number(x));
  if (!values(state.values)) delete state.values;
  for (const k of ["t", "from", "to", "screen", "speed"]) if (!number(state[k])) delete state[k];
  const run = campaign.runs.find((r) => r.name === state.run);
  if (!run) for (const k of ["run", "channel", "t", "from", "to"]) delete state[k];
  else if (!Object.hasOwn(run.channels, state.channel)) delete state.channel;
  state.pins = (Array.isArray(state.pins) ? state.pins : []).filter(values).slice(0, 3);
  if (typeof state.loop !== "boolean") delete state.loop;
  if (typeof state.guess !== "string") delete state.guess;
  if (!["dark", "light"].includes(state.theme)) delete state.theme;
  return state;
}
