// Figures as files: SVG, PNG and PDF, as wide as a journal's column or page, on white, with what they show and a caption.

import { h, save } from "page/dom";
import { PRINT, svg, text, wrapped } from "page/draw";

export const WIDTHS = { 85: 400, 170: 720 }; // mm, and the units of drawing that are as wide
const DPI = 400;
const MARGIN = 12, HEAD = 17, LINE = 14;

/** A figure as it is printed: title, run, drawing and caption. `says` is {title, subject, draw(width, look), caption()}. */
export function sheet(says, mm) {
  const width = WIDTHS[mm], inner = width - 2 * MARGIN, drawn = says.draw(inner, PRINT), height = Number(drawn.getAttribute("height"));
  const head = [...wrapped(says.title, inner / 7.2).map((t) => [t, 600]), ...wrapped(says.subject(), inner / 6.4).map((t) => [t, 400])];
  const foot = wrapped(says.caption(), inner / 5.6), top = MARGIN + head.length * HEAD, whole = top + height + foot.length * LINE + 2 * MARGIN;
  drawn.setAttribute("x", MARGIN);
  drawn.setAttribute("y", top);
  return svg("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${whole}`, width: `${mm}mm`, height: `${((whole * mm) / width).toFixed(2)}mm`, "font-family": "Helvetica, Arial, 'DejaVu Sans', sans-serif", "font-size": 12 },
    svg("title", {}, says.title), svg("desc", {}, says.caption()), svg("rect", { width, height: whole, fill: PRINT.paper }),
    head.map(([t, weight], i) => text(MARGIN, MARGIN + 11 + i * HEAD, t, weight === 600 ? PRINT.ink : PRINT.faint, "start", { "font-weight": weight })),
    drawn, foot.map((t, i) => text(MARGIN, top + height + MARGIN + 4 + i * LINE, t, PRINT.faint, "start", { "font-size": 10.5 })));
}

export const written = (element) => `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(element)}`;

/** The sheet in pixels. */
async function painted(element, mm) {
  const picture = new Image(), [, , across, down] = element.getAttribute("viewBox").split(" ").map(Number);
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(written(element))}`;
  await picture.decode();
  const width = Math.round((mm / 25.4) * DPI), made = h("canvas", { width, height: Math.round((width * down) / across) });
  made.getContext("2d").drawImage(picture, 0, 0, made.width, made.height);
  return made;
}

const FILES = {
  svg: async (element) => new Blob([written(element)], { type: "image/svg+xml" }),
  png: async (element, mm) => new Promise(async (done) => (await painted(element, mm)).toBlob(done, "image/png")),
  pdf: async (element, mm) => pdf(await painted(element, mm), mm),
};

/** Hand out a figure as svg, png or pdf, so many millimetres wide. */
export async function publish(says, kind, mm) {
  save(`${says.file()}-${mm}mm.${kind}`, await FILES[kind](sheet(says, mm), mm));
}

/** One page with one picture, as large as the sheet. */
async function pdf(canvas, mm) {
  const { width, height } = canvas, { data } = canvas.getContext("2d").getImageData(0, 0, width, height), rgb = new Uint8Array(3 * width * height);
  for (let i = 0, j = 0; i < data.length; i += 4) { rgb[j++] = data[i]; rgb[j++] = data[i + 1]; rgb[j++] = data[i + 2]; }
  const packed = new Uint8Array(await new Response(new Blob([rgb]).stream().pipeThrough(new CompressionStream("deflate"))).arrayBuffer());
  const across = ((mm / 25.4) * 72).toFixed(2), down = ((across * height) / width).toFixed(2), drawn = `q ${across} 0 0 ${down} 0 0 cm /P Do Q`;
  const objects = [
    ["<< /Type /Catalog /Pages 2 0 R >>"],
    ["<< /Type /Pages /Kids [3 0 R] /Count 1 >>"],
    [`<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ${across} ${down}] /Contents 4 0 R /Resources << /XObject << /P 5 0 R >> >> >>`],
    [`<< /Length ${drawn.length} >>\nstream\n${drawn}\nendstream`],
    [`<< /Type /XObject /Subtype /Image /Width ${width} /Height ${height} /ColorSpace /DeviceRGB /BitsPerComponent 8 /Filter /FlateDecode /Length ${packed.length} >>\nstream\n`, packed, "\nendstream"],
  ];
  const parts = ["%PDF-1.4\n"], places = [];
  let at = parts[0].length;
  const put = (piece) => { parts.push(piece); at += piece.length; };
  objects.forEach((pieces, i) => { places.push(at); put(`${i + 1} 0 obj\n`); pieces.forEach(put); put("\nendobj\n"); });
  const table = at;
  put(`xref\n0 ${objects.length + 1}\n0000000000 65535 f \n${places.map((p) => `${String(p).padStart(10, "0")} 00000 n \n`).join("")}`);
  put(`trailer\n<< /Size ${objects.length + 1} /Root 1 0 R >>\nstartxref\n${table}\n%%EOF\n`);
  return new Blob(parts, { type: "application/pdf" });
}
