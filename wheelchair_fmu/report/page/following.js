// What the next experiment would show: a run that was never made, as each of two rivals would have it.

import { extent } from "page/draw";
import { labelled, lines } from "page/lines";
import { inUnit } from "page/numbers";
import { capital, channelOf, titleOf } from "page/words";

const COLOURS = ["model", "pin-c"];
const LEAST = 0.6; // of an axis of differences either side of zero, noise = 1

/** What a figure says of the experiment, or null where there is nothing to draw. */
export function following(campaign, subject) {
  const told = campaign.diagnosis.next_experiment, shows = told?.shows, record = campaign.channels.find((c) => c.name === shows?.channel) ?? campaign.next_channel;
  if (!record) return null;
  const { time, noise } = shows, [first, second] = Object.entries(shows.readings), names = [first, second].map(([id]) => `with ${titleOf(campaign, id)}`), factor = record.display[0]?.factor ?? 1;
  const scaled = [first, second].map(([, values]) => values.map((v) => v * factor)), apart = first[1].map((v, i) => (v - second[1][i]) / noise), [low, high] = extent(apart), most = Math.max(LEAST, -low, high);
  return {
    title: `What ${told.manoeuvre} would show`, subject: () => `${campaign.name}, a run that is yet to be made`, file: () => `${campaign.name}-next`,
    draw: (width, look) => lines(width, look, time, [time[0], time.at(-1)], [{ label: labelled(record), lines: scaled.map((values, k) => [names[k], values, COLOURS[k], 2 - k / 2, k ? [5, 3] : null]), height: 170 },
      { label: "apart ÷ noise", lines: [["apart", apart, "error", 1.5]], reach: [-most, most], height: 90 }]),
    columns: () => ({ "time [s]": time, ...Object.fromEntries([first, second].map(([id, values]) => [`${id} [${record.unit}]`, values])), "apart, noise = 1": apart }),
    caption: () => `${capital(channelOf(shows.channel))} as the model would have it in ${told.manoeuvre} ${names[0]} (solid), and as near to that as the model ${names[1]} could come (dashed). Below, how far they are apart, in units of the noise of one reading, ${inUnit(noise, record, 2)}: readings that last show less than that.`,
  };
}
