// A scaling figure: one quantity of several jobs over another, on log axes.
import { number, significant } from "./format.js";
import { logAxis } from "./log_axis.js";
import { curveColour } from "./palette.js";
import { exponent } from "./scaling.js";
import { frame, legend, line, mark, size, svg } from "./svg_parts.js";

function curveName({ name, points }) {
  const slope = points.length > 1 ? exponent(points) : null;
  return slope === null ? name : `${name}: ∝ x^${significant(slope, 2)}`;
}

/// `curves` of scalingCurves(), the quantities' labels, and the width in pixels; null if there is nothing
/// to show.
export function scalingSvg(curves, x, y, width = 720) {
  const all = curves.flatMap((c) => c.points);
  if (all.length === 0) return null;
  const bottom = size.top + size.plot;
  const across = logAxis(all.map((p) => p.x), size.left, width - size.right, 48);
  const up = logAxis(all.map((p) => p.y), bottom, size.top, 20);
  const place = (p) => [across.at(p.x), up.at(p.y)];
  const groups = curves.map((c, i) => svg("g", { class: "curve" }, line(c.points.map(place), curveColour(i)),
    ...c.points.map((p) => {
      const shape = mark(i, ...place(p), false);
      shape.append(svg("title", {}, `${c.name}: ${number(p.y)} at ${number(p.x)}`));
      return shape;
    })));
  const entries = curves.map((c, i) => ({ label: curveName(c), symbol: (u, v) => mark(i, u, v, false) }));
  const names = legend(width, entries, bottom + size.below + size.line / 2);
  const height = bottom + size.below + size.line / 2 + names.height;
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": `${y} against ${x}`,
    "font-family": "DejaVu Sans, Helvetica, Arial, sans-serif" },
  svg("rect", { width, height, fill: "var(--surface)" }),
  ...frame(width, across, up, { label: x }, { label: y }), ...groups, ...names.parts);
}
