// What is wrong with the words of a page as it stands: over each other, cut, too small, too pale. An expression.
(() => {
  const faults = [];
  const root = document.documentElement;
  const said = (element) => `“${element.textContent.trim().replace(/\s+/g, " ").slice(0, 40)}”`;
  const isShown = (element) => element.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  /** What it scrolls in, if it does; what cuts it off, if something does. */
  const holders = (element, kinds) => {
    const found = [];
    for (let at = element; at && at !== root && at !== document.body; at = at.parentElement)
      if (kinds.test(getComputedStyle(at).overflowX + getComputedStyle(at).overflowY)) found.push(at);
    return found;
  };
  const boxes = [];
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const of = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || of.closest("style,script,title,option,pre") || !isShown(of)) continue;
    const range = document.createRange();
    range.selectNodeContents(walker.currentNode);
    const scrollers = holders(of, /auto|scroll/);
    for (const rect of range.getClientRects()) {
      if (rect.width < 1 || rect.height < 1) continue;
      const scrolled = scrollers.some((scroller) => {
        const port = scroller.getBoundingClientRect();
        return rect.left < port.left - 1 || rect.right > port.right + 1 || rect.top < port.top || rect.bottom > port.bottom;
      });
      if (scrolled) continue;
      if (rect.left < -1 || rect.right > innerWidth + 1) faults.push(`${said(of)} is cut by the page's side`);
      const svg = of.closest("svg");
      if (svg) {
        const paper = svg.getBoundingClientRect();
        if (rect.left < paper.left - 1 || rect.right > paper.right + 1) faults.push(`${said(of)} is cut by its plot`);
        if (rect.top < paper.top - 2 || rect.bottom > paper.bottom + 2) faults.push(`${said(of)} is cut by its plot`);
      }
      // Letters fill the middle of their line.
      const fifth = 0.2 * rect.height;
      boxes.push({ of, left: rect.left, right: rect.right, top: rect.top + fifth, bottom: rect.bottom - fifth });
    }
    const style = getComputedStyle(of);
    const scale = of.ownerSVGElement ? of.getScreenCTM().a : 1;
    const size = parseFloat(style.fontSize) * scale;
    if (size < 9.5) faults.push(`${said(of)} is ${size.toFixed(1)} px high`);
    const ink = of.ownerSVGElement ? style.fill : style.color;
    const contrast = ratio(luminance(ink), luminance(paperOf(of)));
    if (contrast < 3) faults.push(`${said(of)} has a contrast of ${contrast.toFixed(1)}`);
  }
  for (const of of document.querySelectorAll("button,input,select,figure canvas")) {
    if (!isShown(of)) continue;
    const { left, right, top, bottom, width } = of.getBoundingClientRect();
    const scrolled = holders(of, /auto|scroll/).some((scroller) => {
      const port = scroller.getBoundingClientRect();
      return top < port.top || bottom > port.bottom;
    });
    if (!width || scrolled) continue;
    if (left < -1 || right > innerWidth + 1) faults.push(`${of.id || said(of)} is cut by the page's side`);
    boxes.push({ of, left, right, top, bottom });
  }
  boxes.sort((a, b) => a.top - b.top);
  boxes.forEach((a, index) => {
    for (const b of boxes.slice(index + 1)) {
      if (b.top > a.bottom - 1) break;
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      if (across < 2 || Math.min(a.bottom, b.bottom) - b.top < 2) continue;
      if (a.of.contains(b.of) || b.of.contains(a.of)) continue;
      faults.push(`${said(a.of)} ${a.of.id} and ${said(b.of)} ${b.of.id} lie over each other`);
    }
  });
  for (const of of document.querySelectorAll("body, body *:not(svg *)")) {
    const { overflowX } = getComputedStyle(of);
    const isCut = of.clientWidth && of.scrollWidth > of.clientWidth + 1 && isShown(of);
    if (isCut && (/hidden|clip/.test(overflowX) || of === document.body)) faults.push(`${said(of)} is cut by ${of.tagName}`);
    if (isCut && /auto|scroll/.test(overflowX) && of.tagName !== "PRE" && (innerWidth > 700 || of.tagName === "ASIDE"))
      faults.push(`${said(of)} scrolls sideways in ${of.tagName}.${of.className}`);
  }
  return [...new Set(faults)];

  /** The colour behind words. */
  function paperOf(element) {
    const paper = element.closest("svg")?.querySelector(".p.f");
    if (paper) return getComputedStyle(paper).fill;
    for (let at = element; at; at = at.parentElement) {
      const { backgroundColor } = getComputedStyle(at);
      if (!/, 0\)$|transparent/.test(backgroundColor)) return backgroundColor;
    }
    return "rgb(255, 255, 255)";
  }

  /** Relative luminance and contrast, as WCAG has them. */
  function luminance(colour) {
    const parts = colour.match(/[\d.]+/g).slice(0, 3).map((part) => part / 255);
    const linear = parts.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  }
  function ratio(a, b) {
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  }
})()
