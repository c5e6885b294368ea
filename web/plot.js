// The plot of error curves on the page: the figure, as wide as there is room.
import { points } from "./curve.js";
import { h } from "./dom.js";
import { figureSvg } from "./figure_svg.js";

const narrowest = 280;

/// A plot of `series` ([{name, rows}], see parseCurve) with the axes' keys `x` and `y`.
/// `draw(series, x, y)` draws anew; it goes with `signal`.
export function plot(signal) {
  const box = h("div.plot");
  const empty = h("p.note", "No errors have been measured.");
  let last = null;
  let width = 0;

  function redraw() {
    if (!last || width === 0) return;
    box.replaceChildren(figureSvg(...last, Math.max(narrowest, width)) ?? empty);
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
    draw(series, x, y) {
      last = [series, x, y];
      const curves = y ? series.map((s) => points(s.rows, x, y)) : [];
      box.dataset.curves = curves.filter((c) => c.length > 0).length;
      box.dataset.points = curves.flat().length;
      redraw();
    },
  };
}
