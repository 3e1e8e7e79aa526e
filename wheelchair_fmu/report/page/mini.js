// The shown channel, small, beside the numbers that stay in sight: on a phone a tick and its effect are on one screen.

import { extent } from "page/draw";

const POINTS = 240;

/** Measured and model, (n,) each, on a <canvas> of this size; nothing is drawn where the page has no place for it. */
export function mini(canvas, [width, height], look, measured, model) {
  const scale = devicePixelRatio || 1;
  if (!width) return;
  [canvas.width, canvas.height] = [width * scale, height * scale];
  const c = canvas.getContext("2d"), [low, high] = extent(measured, model), step = Math.max(1, Math.floor(model.length / POINTS));
  c.scale(scale, scale);
  for (const [series, colour, thick] of [[measured, look.measured, 1], [model, look.model, 2]]) {
    c.strokeStyle = colour;
    c.lineWidth = thick;
    c.beginPath();
    for (let i = 0; i < series.length; i += step)
      if (Number.isFinite(series[i])) c.lineTo((width * i) / series.length, 2 + (height - 4) * (1 - (series[i] - low) / (high - low || 1)));
    c.stroke();
  }
}
