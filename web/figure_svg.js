// Error curves as an SVG whose colours are the page's (see figure_file.js for one that needs nothing else).
import { axes, points, slopeLine, slopeName } from "./curve.js";
import { number } from "./format.js";
import { metrics } from "./job_tables.js";
import { logAxis } from "./log_axis.js";
import { curveColour } from "./palette.js";
import { axisTitle, frame, legend, line, mark, muted, size, svg } from "./svg_parts.js";

/// A curve and its marks, each of which tells its values.
function curveGroup(i, name, curve, place, unit, metric) {
  const told = curve.map((p) => {
    const shape = mark(i, ...place(p), p.floor);
    shape.append(svg("title", {}, `${name}: ${metric.label} ${number(p.y)} at ${number(p.x)} ${unit}`
      + `${p.floor ? ", at the floor" : ""}`));
    return shape;
  });
  return svg("g", { class: "curve" }, line(curve.map(place), curveColour(i)), ...told);
}

/// `series` ([{name, rows}]) over the axes' keys `x` and `y`, `width` pixels wide; null if there is
/// nothing to show.
export function figureSvg(series, xKey, yKey, width = 720) {
  const axis = axes.find((a) => a.key === xKey);
  const metric = metrics.find((m) => m.key === yKey);
  const curves = metric ? series.map((s) => points(s.rows, xKey, yKey)) : [];
  const all = curves.flat();
  if (all.length === 0) return null;
  const bottom = size.top + size.plot;
  const x = logAxis(all.map((p) => p.x), size.left, width - size.right, 48);
  const y = logAxis(all.map((p) => p.y), bottom, size.top, 20);
  const place = (p) => [x.at(p.x), y.at(p.y)];
  const entries = series.map(({ name }, i) => ({ label: name, symbol: (u, v) => mark(i, u, v, false) }));
  const slope = slopeLine(curves, metric.slope);
  const dashed = { "stroke-dasharray": "6 4", "stroke-width": 1 };
  if (slope.length > 0) {
    entries.push({ label: `slope ${slopeName(metric.slope)} (Monte Carlo)`,
      symbol: (u, v) => line([[u - 10, v], [u + 10, v]], muted, dashed) });
  }
  if (all.some((p) => p.floor)) {
    entries.push({ label: "hollow: at the reference's own noise", symbol: (u, v) => mark(0, u, v, true) });
  }
  const top = bottom + size.below + size.line / 2;
  const names = legend(width, entries, top);
  const height = top + names.height;
  const clip = svg("clipPath", { id: "plot" }, svg("rect", {
    x: size.left, y: size.top, width: width - size.left - size.right, height: size.plot }));
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
    "aria-label": `${axisTitle(metric)} against ${axisTitle(axis)}`,
    "font-family": "DejaVu Sans, Helvetica, Arial, sans-serif" },
  clip, svg("rect", { width, height, fill: "var(--surface)" }), ...frame(width, x, y, axis, metric),
  svg("g", { "clip-path": "url(#plot)" }, line(slope.map(place), muted, dashed)),
  ...curves.map((curve, i) => curveGroup(i, series[i].name, curve, place, axis.unit || axis.label, metric)),
  ...names.parts);
}
