// How high the smallest letters are that a print has, in points, and what is written with them. The window is as wide as an A4
// page between its margins, and print's style holds.
() => {
  dispatchEvent(new Event("beforeprint"));
  const words = document.createTreeWalker(document.querySelector("body"), NodeFilter.SHOW_TEXT), all = [];
  while (words.nextNode()) {
    const text = words.currentNode.textContent.trim(), element = words.currentNode.parentElement;
    if (!text || !element.checkVisibility() || !element.getClientRects().length || element.closest("script, style, .unseen")) continue;
    const matrix = element.closest("svg") ? element.getScreenCTM() : null, scale = matrix ? Math.hypot(matrix.a, matrix.b) : 1;
    all.push([0.75 * scale * parseFloat(getComputedStyle(element).fontSize), text]);
  }
  return all.sort(([a], [b]) => a - b)[0];
}
