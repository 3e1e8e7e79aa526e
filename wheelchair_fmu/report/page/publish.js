// Figures as files: SVG, PNG and PDF, as wide as a journal's column or page, on white, with what they show and a caption.
// SVG and PDF are drawn by lines and letters, and carry their fonts.

import { byId, h, save, unpacked } from "page/dom";
import { FONT, PRINT, PRINTED, broken, svg, text } from "page/draw";

export const WIDTHS = { 85: 400, 170: 720 }; // mm, and the units of drawing that are as wide
const DPI = 400;
const HEADED = 33; // bytes of a PNG's signature and header, which come first
// Letters that join, change places or stand on others, or run from right to left: a browser sets them, what writes PDF does not.
const SHAPED = /[\p{M}\p{Script=Arabic}\p{Script=Hebrew}\p{Script=Syriac}\p{Script=Thaana}\p{Script=Nko}\p{Script=Thai}\p{Script=Lao}\p{Script=Devanagari}\p{Script=Bengali}\p{Script=Tamil}]/u;
const MARGIN = 12, HEAD = 17, LINE = 14;
let press = null;

/** Fonts, and what writes PDF, unpacked when a figure is first asked for. */
async function pressed() {
  if (press) return press;
  const made = await unpacked(byId("press").textContent);
  for (const [weight, font] of Object.entries(made.fonts)) document.fonts.add(await new FontFace(FONT, Uint8Array.from(atob(font), (c) => c.charCodeAt(0)), { weight }).load());
  for (const script of made.scripts) await run(script);
  return (press = made);
}

const run = (script) => new Promise((done, failed) => {
  const src = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  document.head.append(h("script", { src, onload: () => { URL.revokeObjectURL(src); done(); }, onerror: () => failed(new Error("what writes figures did not start")) }));
});

/** The fonts as a style sheet within a figure. */
const faces = ({ fonts }) => svg("style", {}, Object.entries(fonts).map(([weight, font]) => `@font-face{font-family:"${FONT}";font-weight:${weight};src:url(data:font/ttf;base64,${font})}`).join(""));

/** A figure as it is printed: title, run, drawing and caption. `says` is {title, subject, draw(width, look), caption()}. */
function sheet(says, mm) {
  const width = WIDTHS[mm], inner = width - 2 * MARGIN, drawn = says.draw(inner, PRINT), height = Number(drawn.getAttribute("height"));
  const head = [...broken(says.title, inner, PRINT, 12, 700).map((t) => [t, PRINT.ink, "bold"]), ...broken(says.subject(), inner, PRINT).map((t) => [t, PRINT.faint, "normal"])];
  const foot = broken(says.caption(), inner, PRINT, 10.5), top = MARGIN + head.length * HEAD, whole = top + height + foot.length * LINE + 2 * MARGIN;
  for (const [name, value] of Object.entries({ x: MARGIN, y: top, "font-family": PRINTED })) drawn.setAttribute(name, value);
  for (const t of drawn.querySelectorAll("[font-weight]")) t.setAttribute("font-weight", Number(t.getAttribute("font-weight")) >= 600 ? "bold" : "normal"); // there are two faces
  return svg("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${whole}`, width: `${mm}mm`, height: `${((whole * mm) / width).toFixed(2)}mm`, "font-family": PRINTED, "font-size": 12 },
    svg("title", {}, says.title), svg("desc", {}, says.caption()), svg("rect", { width, height: whole, fill: PRINT.paper }),
    head.map(([t, colour, weight], i) => text(MARGIN, MARGIN + 11 + i * HEAD, t, colour, "start", { "font-weight": weight })),
    drawn, foot.map((t, i) => text(MARGIN, top + height + MARGIN + 4 + i * LINE, t, PRINT.faint, "start", { "font-size": 10.5 })));
}

const written = (element) => `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(element)}`;

function withFonts(element) {
  element.prepend(faces(press));
  return element;
}

/** The sheet in pixels. */
async function painted(element, mm) {
  const picture = new Image(), [, , across, down] = element.getAttribute("viewBox").split(" ").map(Number);
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(written(withFonts(element)))}`;
  await picture.decode();
  const width = Math.round((mm / 25.4) * DPI), made = h("canvas", { width, height: Math.round((width * down) / across) });
  made.getContext("2d").drawImage(picture, 0, 0, made.width, made.height);
  return made;
}

/** Lines and letters; a picture of them where a name has letters that the fonts do not have, or that need setting. */
async function pdf(element, mm) {
  const [, , across, down] = element.getAttribute("viewBox").split(" ").map(Number), high = (mm * down) / across, box = { x: 0, y: 0, width: mm, height: high };
  const made = new jspdf.jsPDF({ unit: "mm", format: [mm, high], orientation: high > mm ? "portrait" : "landscape", compress: true, putOnlyUsedFonts: true });
  const said = [...element.querySelectorAll("text")].map((t) => t.textContent).join("");
  made.setDocumentProperties({ title: element.querySelector("title").textContent, subject: element.querySelector("desc").textContent });
  if (SHAPED.test(said) || [...said].some((c) => press.lacking.includes(c))) made.addImage(await painted(element, mm), "PNG", 0, 0, mm, high, undefined, "FAST");
  else {
    for (const [style, font] of Object.entries(press.fonts)) {
      made.addFileToVFS(`${style}.ttf`, font);
      made.addFont(`${style}.ttf`, FONT, style);
    }
    await made.svg(element, box);
  }
  return made.output("blob");
}

/** A PNG that says how many dots stand on a metre, as a browser's do not: else what sets text takes 85 mm for 350. */
async function dense(blob) {
  const chunk = new DataView(new ArrayBuffer(21)), dots = Math.round(DPI / 0.0254);
  chunk.setUint32(0, 9);
  [..."pHYs"].forEach((c, i) => chunk.setUint8(4 + i, c.charCodeAt(0)));
  [8, 12].forEach((at) => chunk.setUint32(at, dots));
  chunk.setUint8(16, 1); // metres
  let check = ~0;
  for (const byte of new Uint8Array(chunk.buffer, 4, 13)) {
    check ^= byte;
    for (let bit = 0; bit < 8; bit++) check = (check >>> 1) ^ (0xedb88320 & -(check & 1));
  }
  chunk.setUint32(17, ~check >>> 0);
  return new Blob([blob.slice(0, HEADED), chunk, blob.slice(HEADED)], { type: blob.type });
}

const FILES = {
  svg: async (element) => new Blob([written(withFonts(element))], { type: "image/svg+xml" }),
  png: async (element, mm) => { const canvas = await painted(element, mm); return dense(await new Promise((done) => canvas.toBlob(done, "image/png"))); },
  pdf,
};

/** Hand out a figure as svg, png or pdf, so many millimetres wide. */
export async function publish(says, kind, mm) {
  await pressed();
  save(`${says.file()}-${mm}mm.${kind}`, await FILES[kind](sheet(says, mm), mm));
}
