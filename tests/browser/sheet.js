// What is wrong with the words of a figure that stands alone in an SVG file: outside of it, over one another, or too small to read.
() => {
  const letters = (t) => { // where its letters are: Firefox's box has the space between two lines too
    const { left, right, top, bottom } = t.getBoundingClientRect(), { a, b, c, d } = t.getScreenCTM(), size = 1.17 * parseFloat(getComputedStyle(t).fontSize);
    const [x, y] = Math.abs(b) > Math.abs(a) ? [Math.max(0, right - left - size * Math.hypot(c, d)) / 2, 0] : [0, Math.max(0, bottom - top - size * Math.hypot(c, d)) / 2];
    return { left: left + x, right: right - x, top: top + y, bottom: bottom - y, height: bottom - top - 2 * y };
  };
  const sheet = document.documentElement, whole = sheet.getBoundingClientRect(), unit = whole.width / sheet.viewBox.baseVal.width, points = ((parseFloat(sheet.getAttribute("width")) / 25.4) * 72) / sheet.viewBox.baseVal.width;
  const all = [...sheet.querySelectorAll("text")].filter((t) => t.textContent.trim()).map((t) => ({ words: t.textContent, size: parseFloat(getComputedStyle(t).fontSize) * points, box: letters(t), within: t.ownerSVGElement }));
  const wrong = [], drawing = ({ x, y, width, height }) => {
    const [left, top] = [whole.left + unit * x.baseVal.value, whole.top + unit * y.baseVal.value];
    return { left, top, right: left + unit * width.baseVal.value, bottom: top + unit * height.baseVal.value };
  };
  all.forEach((one, i) => {
    const { box, words } = one;
    const frame = one.within === sheet ? whole : drawing(one.within);
    if (box.left < frame.left - 0.5 || box.right > frame.right + 0.5 || box.top < frame.top - 0.5 || box.bottom > frame.bottom + 0.5) wrong.push(`outside: ${words}`);
    if (one.size < 6) wrong.push(`${one.size.toFixed(1)} points: ${words}`);
    for (const other of all.slice(0, i)) {
      const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left), down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
      if (across > 1.5 && down > 0.35 * Math.min(box.height, other.box.height)) wrong.push(`over one another: ${words} and ${other.words}`);
    }
  });
  return wrong;
}
