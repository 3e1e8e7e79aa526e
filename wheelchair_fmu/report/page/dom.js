// Elements, without a framework: text is always text, never markup.

/** h("td", {class: "number"}, "1.0") */
export function h(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return made;
}

export const byId = (id) => document.getElementById(id);

/** Series come as base64 of little-endian doubles, {f64: "..."}; everything else as it is. */
export function decoded(value) {
  if (value === null || typeof value !== "object") return value;
  if (typeof value.f64 === "string") {
    const bytes = Uint8Array.from(atob(value.f64), (c) => c.charCodeAt(0));
    return new Float64Array(bytes.buffer);
  }
  if (Array.isArray(value)) return value.map(decoded);
  return Object.fromEntries(Object.entries(value).map(([k, v]) => [k, decoded(v)]));
}

/** Offer text or an address as a file. */
export function save(name, content, type = "text/csv;charset=utf-8") {
  const url = content instanceof Blob || !content.startsWith("data:") ? URL.createObjectURL(new Blob([content], { type })) : content;
  h("a", { href: url, download: name }).click();
  if (url.startsWith("blob:")) setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Columns {header: array} as CSV. */
export function csv(columns) {
  const names = Object.keys(columns), lines = [names.map(cell).join(",")];
  const length = Math.max(...names.map((n) => columns[n].length));
  for (let i = 0; i < length; i++) lines.push(names.map((n) => cell(columns[n][i])).join(","));
  return lines.join("\n") + "\n";
}

function cell(value) {
  if (value === undefined || value === null || Number.isNaN(value)) return "";
  const text = String(value);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
