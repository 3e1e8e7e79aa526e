// What a program can see by itself of what is wrong with the page as it stands.
() => {
  const wrong = new Set(), shown = (e) => e.checkVisibility() && e.getClientRects().length && !e.closest(".unseen, [hidden]");
  if (document.documentElement.scrollWidth > innerWidth) wrong.add(`${document.documentElement.scrollWidth} px wide`);
  const letters = (t) => { // where its letters are: Firefox's box has the space between two lines too
    const { left, right, top, bottom } = t.getBoundingClientRect(), { a, b, c, d } = t.getScreenCTM(), size = 1.17 * parseFloat(getComputedStyle(t).fontSize);
    const [x, y] = Math.abs(b) > Math.abs(a) ? [Math.max(0, right - left - size * Math.hypot(c, d)) / 2, 0] : [0, Math.max(0, bottom - top - size * Math.hypot(c, d)) / 2];
    return { left: left + x, right: right - x, top: top + y, bottom: bottom - y, height: bottom - top - 2 * y };
  };
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const words = texts.currentNode.textContent.trim(), e = texts.currentNode.parentElement;
    if (!words || e.closest("script, style, .menu, code") || !shown(e)) continue;
    if (/undefined|NaN|Infinity|\[object|(?<![\w-])null\b|(?<![\w-])-\d/.test(words)) wrong.add(`number: ${words.slice(0, 90)}`);
    if (/\b[a-z]+_[a-z_]+\b|\b(effect|chair|tyre|resistance)\.\w/.test(words) && !e.closest(".figures, .numbers, details table")) wrong.add(`code name: ${words.slice(0, 90)}`);
    if (/\b(p-value|whitened|likelihood|posterior|covariance|cosine|ln L)\b/i.test(words) && !e.closest("#method, details table")) wrong.add(`jargon: ${words.slice(0, 90)}`);
    const size = parseFloat(getComputedStyle(e).fontSize);
    if (size < 10 && !e.closest("svg")) wrong.add(`${size} px: ${words.slice(0, 60)}`);
    if (!e.closest("svg, .wide, pre, .u-legend, .uplot, #steps")) {
      const range = document.createRange();
      range.selectNodeContents(texts.currentNode);
      const box = range.getBoundingClientRect();
      for (let over = e; over && over !== document.body; over = over.parentElement) {
        const style = getComputedStyle(over);
        if (style.overflowX !== "visible" && box.right > over.getBoundingClientRect().right + 1) { wrong.add(`cut off: ${words.slice(0, 60)}`); break; }
      }
    }
  }
  for (const svg of document.querySelectorAll("svg")) {
    if (!shown(svg) || svg.parentElement.closest("svg")) continue;
    const frame = svg.getBoundingClientRect(), all = [...svg.querySelectorAll("text")].filter((t) => t.textContent.trim() && shown(t)).map((t) => ({ words: t.textContent, box: letters(t), size: parseFloat(getComputedStyle(t).fontSize) * frame.width / (svg.viewBox.baseVal.width || frame.width), turned: /rotate/.test(t.getAttribute("transform") ?? "") }));
    all.forEach((one, i) => {
      const { box, words } = one;
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1) wrong.add(`outside its drawing: ${words}`);
      if (one.size < 9.5) wrong.add(`${one.size.toFixed(1)} px in a drawing: ${words}`);
      for (const other of all.slice(0, i)) {
        const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left), down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
        if (across > 1.5 && down > 0.35 * Math.min(box.height, other.box.height)) wrong.add(`over one another: ${words} and ${other.words}`);
      }
    });
  }
  return [...wrong];
}
