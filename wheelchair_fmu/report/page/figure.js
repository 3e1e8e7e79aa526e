// A figure's frame: a heading, a place to draw, and buttons that hand out what is drawn.

import { h, save } from "page/dom";

/** Fills a <figure>; returns the place to draw in. */
export function figure(place, title, downloads) {
  const id = `${place.id}-title`, drawing = h("div", { class: "drawing" });
  const buttons = Object.entries(downloads).map(([kind, act]) => h("button", { type: "button", class: "quiet", "aria-label": `${title} as ${kind}`, onclick: act }, kind));
  place.setAttribute("aria-labelledby", id);
  place.append(h("figcaption", {}, h("h3", { id }, title), h("span", { class: "tools" }, buttons)), drawing);
  return drawing;
}

/** An SVG element as a file, SVG or PNG by the name's ending, with the styles it has on the page. */
export async function image(element, name) {
  const copy = element.cloneNode(true), { width, height } = element.viewBox.baseVal;
  const styled = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font", "opacity", "vector-effect"];
  const [from, to] = [element, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  from.forEach((node, i) => {
    const style = getComputedStyle(node);
    for (const property of styled) to[i].style.setProperty(property, style.getPropertyValue(property));
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  copy.style.background = getComputedStyle(document.body).backgroundColor;
  const blob = new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" });
  if (name.endsWith(".svg")) return save(name, blob);
  const picture = new Image(), url = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(await blob.text())}`;
  picture.src = url;
  await picture.decode();
  const canvas = h("canvas", { width: 2 * width, height: 2 * height });
  canvas.getContext("2d").drawImage(picture, 0, 0, 2 * width, 2 * height);
  save(name, canvas.toDataURL("image/png"));
}
