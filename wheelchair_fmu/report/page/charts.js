// The charts, by Plotly. Colours are Okabe and Ito's; fitted and held out differ in pattern too.

import { byId, csv, save } from "page/dom";
import { byChannel, excessBy } from "page/errors";
import { figure } from "page/figure";
import { between, display, rms, significant, unitText } from "page/numbers";

const CONFIG = { displayModeBar: false, responsive: true };
const FLOOR = 1;
// cividis, from light to dark: told apart by every kind of colour vision, and in print
const CIVIDIS = [[253, 234, 69], [220, 200, 93], [188, 173, 108], [155, 147, 118], [125, 124, 120], [94, 99, 111], [57, 72, 107], [0, 34, 78]];

export class Charts {
  constructor(campaign, choose) {
    Object.assign(this, { campaign, choose });
    this.places = {};
    this.frame("staircase", "The error falling, step by step", () => this.ladderColumns());
    this.frame("where", "Where the error is: whitened RMS by run and channel", () => this.whereColumns);
    this.frame("overlay", "Measured and simulated", () => this.overlayColumns);
    this.frame("regimes", "When the error is: whitened RMS by quarters of all samples", () => this.regimeColumns);
    this.recolour();
  }

  frame(id, title, columns) {
    const name = () => `${this.campaign.name}-${id}`;
    const picture = (format) => async () => save(`${name()}.${format}`, await Plotly.toImage(this.places[id], { format, width: 960, height: this.places[id].offsetHeight, scale: 2 }));
    this.places[id] = figure(byId(id), title, { PNG: picture("png"), SVG: picture("svg"), CSV: () => save(`${name()}.csv`, csv(columns())) });
  }

  recolour() {
    const style = getComputedStyle(document.documentElement), of = (name) => style.getPropertyValue(name).trim();
    this.colour = Object.fromEntries(["ink", "faint", "line", "paper", "fit", "heldout", "band", "measured"].map((n) => [n, of(`--${n}`)]));
    this.dark = style.colorScheme.includes("dark") && !style.colorScheme.includes("light");
  }

  narrow(id) {
    return this.places[id].offsetWidth < 520;
  }

  layout(more) {
    const { ink, line, paper } = this.colour;
    const axis = { gridcolor: line, zerolinecolor: line, linecolor: line, tickcolor: line, automargin: true };
    const axes = Object.fromEntries(Object.entries(more).filter(([k]) => /^[xy]axis/.test(k)).map(([k, v]) => [k, { ...axis, ...v }]));
    return { font: { family: "system-ui, sans-serif", size: 13, color: ink }, paper_bgcolor: paper, plot_bgcolor: paper, margin: { l: 56, r: 14, t: 26, b: 40 },
      hoverlabel: { bgcolor: paper, bordercolor: line, font: { color: ink } }, ...more, ...axes };
  }

  draw(id, traces, layout) {
    return Plotly.react(this.places[id], traces, this.layout(layout), CONFIG);
  }

  staircase(now) {
    this.now = now;
    const steps = [...this.campaign.diagnosis.ladder, { step: "in this page now", ...now }];
    const narrow = this.narrow("staircase"), names = steps.map((s) => wrapped(s.step, narrow ? 6 : 12));
    const bars = [["fit", "fitted runs", "", "fit"], ["heldout", "held-out runs", "/", "heldout"]].map(([key, name, shape, colour]) => ({
      type: "bar", name, x: names, base: FLOOR, y: steps.map((s) => (s[key] ?? NaN) - FLOOR),
      text: steps.map((s) => rms(s[key])), textposition: "outside", cliponaxis: false,
      customdata: steps.map((s) => s[key]), hovertemplate: "%{customdata:.3f}<extra>%{fullData.name}</extra>",
      marker: { color: this.colour[colour], pattern: { shape, fillmode: "overlay", fgcolor: this.colour.paper, fgopacity: 0.7, size: 7, solidity: 0.2 },
        line: { color: this.colour.ink, width: steps.map((_, i) => (i === steps.length - 1 ? 1.5 : 0)) } },
    }));
    const most = Math.max(2, ...steps.flatMap((s) => [s.fit, s.heldout]).filter(Number.isFinite));
    const ticks = [1, 1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 200, 500, 1000].filter((t) => t <= 1.3 * most);
    const shown = ticks.length > 8 ? ticks.filter((t) => /^[125]0*$/.test(String(t))) : ticks;
    this.draw("staircase", bars, {
      height: 330, barmode: "group", bargap: 0.3, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
      xaxis: { fixedrange: true, tickangle: 0, tickfont: { size: narrow ? 10 : 13 } },
      yaxis: { type: "log", range: [Math.log10(steps.some((s) => s.fit < FLOOR || s.heldout < FLOOR) ? 0.78 : 0.93), Math.log10(1.35 * most)], tickvals: shown, fixedrange: true, title: { text: "whitened RMS error" } },
      shapes: [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: FLOOR, y1: FLOOR, line: { color: this.colour.ink, width: 1.5, dash: "dash" } }],
      margin: { l: 56, r: 48, t: 26, b: 40 },
      annotations: [{ xref: "paper", x: 1, xanchor: "left", y: Math.log10(FLOOR), yanchor: "middle", yref: "y", align: "left", text: " noise<br> floor", showarrow: false, font: { size: 12 } }],
    });
  }

  ladderColumns() {
    const steps = [...this.campaign.diagnosis.ladder, { step: "in this page now", ...this.now }];
    return { step: steps.map((s) => s.step), "fitted runs": steps.map((s) => s.fit), "held-out runs": steps.map((s) => s.heldout) };
  }

  /** Bars as cells: width 1 at place c, on the row of their run. */
  where(results, shown) {
    const { runs, channels } = this.campaign, cells = { run: [], channel: [], value: [], at: [], row: [] };
    const label = (r) => (r.role === "holdout" ? `◇ ${r.name}` : r.name);
    runs.forEach((run, i) => {
      for (const [channel, value] of Object.entries(results[i] ? byChannel(results[i]) : {})) {
        cells.run.push(label(run)); cells.channel.push(channel); cells.value.push(value); cells.row.push(i);
        cells.at.push(channels.findIndex((c) => c.name === channel));
      }
    });
    this.whereColumns = { run: cells.row.map((i) => runs[i].name), role: cells.row.map((i) => runs[i].role), channel: cells.channel, "whitened RMS": cells.value };
    const size = cells.value.map((v) => Math.log10(Math.max(v, FLOOR))), most = Math.max(0.5, ...size);
    const chosen = cells.row.map((row, k) => row === shown.run && cells.channel[k] === shown.channel);
    const place = this.places.where, narrow = this.narrow("where");
    this.draw("where", [{
      type: "bar", orientation: "h", y: cells.run, x: cells.at.map(() => 0.97), base: cells.at.map((a) => a - 0.485), width: 0.94,
      text: cells.value.map((v) => (v < 100 ? rms(v) : significant(v, 3))), textposition: "inside", insidetextanchor: "middle", textangle: 0, constraintext: "none",
      insidetextfont: { color: size.map((s) => (s > 0.5 * most ? "#fff" : "#111")), size: narrow ? 11 : 13 },
      customdata: cells.channel, hovertemplate: "%{y}<br>%{customdata}: %{text}<extra></extra>",
      marker: { color: size.map((s) => shade(s / most)), line: { width: chosen.map((c) => (c ? 3 : 0)), color: this.colour.heldout } },
    }], {
      height: 64 + 27 * runs.length, margin: { l: 10, r: 10, t: narrow ? 54 : 44, b: 22 }, showlegend: false,
      xaxis: { side: "top", range: [-0.5, channels.length - 0.5], tickvals: channels.map((_, i) => i), tickangle: 0, tickfont: { size: narrow ? 11 : 13 },
        ticktext: channels.map((c) => c.name.replace("wheel_speed_", narrow ? "wheel<br>speed<br>" : "wheel<br>speed ").replace("yaw_rate", narrow ? "yaw<br>rate" : "yaw rate").replaceAll("_", " ")), showgrid: false, zeroline: false, fixedrange: true },
      yaxis: { autorange: "reversed", showgrid: false, fixedrange: true, tickfont: { size: narrow ? 11 : 13 } },
      annotations: [{ xref: "paper", yref: "paper", x: 1, y: 0, xanchor: "right", yanchor: "top", showarrow: false, text: "◇ held out; 1.0 is the noise floor; choose a cell to see it", font: { size: 11 } }],
    });
    if (!place.listening) {
      place.listening = true;
      place.on("plotly_click", ({ points: [point] }) => this.choose(this.cells.row[point.pointIndex], this.cells.channel[point.pointIndex]));
    }
    this.cells = cells;
  }

  /** `before` is the same run as the page opened with. */
  overlay({ run: index, channel }, result, before) {
    const run = this.campaign.runs[index], record = this.campaign.channels.find((c) => c.name === channel), { unit, factor } = display(record);
    const scaled = (series) => (factor === 1 ? series : series.map((v) => v * factor));
    const measured = scaled(run.channels[channel]), predicted = scaled(result.predicted[channel]), e = result.errors[channel];
    const was = before && before !== result ? scaled(before.predicted[channel]) : predicted;
    this.overlayColumns = { "time [s]": run.time, [`measured [${unit}]`]: measured, [`simulated [${unit}]`]: predicted, "error [sd]": e };
    const most = Math.max(4, ...e.filter(Number.isFinite).map(Math.abs));
    this.draw("overlay", [
      { x: run.time, y: measured, name: "measured", mode: "lines", line: { color: this.colour.measured, width: 1 } },
      { x: run.time, y: was, name: "as the page opened", showlegend: was !== predicted, visible: was !== predicted, mode: "lines", line: { color: this.colour.ink, width: 1, dash: "dot" } },
      { x: run.time, y: predicted, name: "simulated", mode: "lines", line: { color: this.colour.fit, width: 2 } },
      { x: run.time, y: e, name: "error in σ", mode: "lines", yaxis: "y2", line: { color: this.colour.heldout, width: 1 } },
    ], {
      height: 400, hovermode: "x", legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
      title: undefined, xaxis: { title: { text: "time [s]" }, anchor: "y2", hoverformat: ".2f" },
      yaxis: { domain: [0.42, 1], title: { text: `${channel.replaceAll("_", " ")} [${unitText(unit) || "1"}]` }, hoverformat: ".4~g" },
      yaxis2: { domain: [0, 0.34], title: { text: "error [σ]" }, range: [-1.1 * most, 1.1 * most], hoverformat: ".2f" },
      shapes: [{ type: "rect", xref: "paper", x0: 0, x1: 1, yref: "y2", y0: -2, y1: 2, fillcolor: this.colour.band, line: { width: 0 }, layer: "below" }],
    });
  }

  regimes(results) {
    const rows = excessBy(this.campaign.regimes, this.campaign.runs, results), names = [...new Set(rows.map((r) => r.name))];
    const records = new Map(this.campaign.regimes.map((r) => [r.name, r]));
    const narrow = this.narrow("regimes"), cells = rows.map((r) => ({ ...r, at: rows.filter((o) => o.name === r.name).indexOf(r) }));
    this.regimeColumns = { regime: rows.map((r) => r.name), from: rows.map((r) => r.from), to: rows.map((r) => r.to), "whitened RMS": rows.map((r) => r.rms), "share of the excess": rows.map((r) => r.share) };
    const size = rows.map((r) => Math.log10(Math.max(r.rms, FLOOR))), most = Math.max(0.5, ...size);
    this.draw("regimes", [{
      type: "bar", orientation: "h", y: cells.map((r) => r.name), x: cells.map(() => 0.97), base: cells.map((r) => r.at - 0.485), width: 0.92,
      text: cells.map((r) => `${rms(r.rms)}<br>${between(r.from, r.to, records.get(r.name)).replace(narrow ? " to " : "", narrow ? " to<br>" : "")}`), textposition: "inside", insidetextanchor: "middle", textangle: 0, constraintext: "none",
      customdata: rows.map((r) => 100 * r.share), hovertemplate: "%{y}: %{text}<br>%{customdata:.0f} % of the excess<extra></extra>", insidetextfont: { size: narrow ? 10 : 11, color: size.map((s) => (s > 0.5 * most ? "#fff" : "#111")) },
      marker: { color: size.map((s) => shade(s / most)) },
    }], {
      height: 40 + (narrow ? 54 : 44) * names.length, margin: { l: 10, r: 10, t: 24, b: 10 }, showlegend: false,
      xaxis: { side: "top", range: [-0.5, 3.5], tickvals: [0, 3], ticktext: ["least", "greatest"], showgrid: false, zeroline: false, fixedrange: true },
      yaxis: { autorange: "reversed", showgrid: false, fixedrange: true },
    });
  }
}

const wrapped = (step, length) => step.replace("+", "+ ").replaceAll("_", " ").replace(new RegExp(`(.{${length},}?) `, "g"), "$1<br>");

/** A colour of the heat maps, for 0 to 1. */
function shade(part) {
  const at = Math.min(Math.max(part, 0), 1) * (CIVIDIS.length - 1), i = Math.min(Math.floor(at), CIVIDIS.length - 2);
  return `rgb(${CIVIDIS[i].map((c, k) => Math.round(c + (CIVIDIS[i + 1][k] - c) * (at - i))).join(",")})`;
}
