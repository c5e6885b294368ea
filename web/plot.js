// Figures on the page, as wide as there is room.
import { points } from "./curve.js";
import { h } from "./dom.js";
import { figureSvg } from "./figure_svg.js";

const narrowest = 280;

/// A place for a figure. `draw(make)` shows what `make(width)` gives, an SVG element, or `empty` where it
/// gives null; and again when the width changes. It goes with `signal`.
export function figureBox(empty, signal) {
  const box = h("div.plot");
  const nothing = h("p.note", empty);
  let make = null;
  let width = 0;

  function redraw() {
    if (!make || width === 0) return;
    box.replaceChildren(make(Math.max(narrowest, width)) ?? nothing);
  }
  const watch = new ResizeObserver(([entry]) => {
    const now = Math.floor(entry.contentRect.width);
    if (now === width) return;
    width = now;
    redraw();
  });
  watch.observe(box);
  signal.addEventListener("abort", () => watch.disconnect());
  return {
    element: h("figure", box),
    /// `curves`: of how many, and `count` of how many points the figure is, for those who look for them.
    draw(next, curves, count) {
      make = next;
      box.dataset.curves = curves;
      box.dataset.points = count;
      redraw();
    },
  };
}

/// A plot of error curves, `series` ([{name, rows}], see parseCurve), with the axes' keys `x` and `y`:
/// `draw(series, x, y)`.
export function plot(signal) {
  const figure = figureBox("No errors have been measured.", signal);
  return {
    element: figure.element,
    draw(series, x, y) {
      const curves = y ? series.map((s) => points(s.rows, x, y)) : [];
      figure.draw((width) => figureSvg(series, x, y, width), curves.filter((c) => c.length > 0).length,
        curves.flat().length);
    },
  };
}
