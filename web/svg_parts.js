// What figures are made of, as SVG whose colours are the page's.
import { tickLabel } from "./log_axis.js";
import { colours, curveColour } from "./palette.js";

export const size = { left: 68, right: 14, top: 14, plot: 360, below: 52, line: 18, column: 320, letter: 6.6 };

const grid = "var(--line)";
export const muted = "var(--muted)";

/// An SVG element with attributes; never with `style`, which the page's policy forbids.
export function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/// "render time (s)".
export const axisTitle = ({ label, unit }) => (unit ? `${label} (${unit})` : label);

/// Marks that are told apart without their colours.
const marks = [
  (x, y, r) => svg("circle", { cx: x, cy: y, r }),
  (x, y, r) => svg("rect", { x: x - r, y: y - r, width: 2 * r, height: 2 * r }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.2 * r}l${1.2 * r} ${2.2 * r}h${-2.4 * r}z` }),
  (x, y, r) => svg("path", { d: `M${x} ${y - 1.4 * r}l${1.4 * r} ${1.4 * r}l${-1.4 * r} ${1.4 * r}`
    + `l${-1.4 * r} ${-1.4 * r}z` }),
];

export const text = (content, attributes) =>
  svg("text", { fill: "var(--text)", "font-size": 12, ...attributes }, content);

export const line = (places, stroke, more = {}) => svg("polyline", {
  points: places.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" "),
  fill: "none", stroke, "stroke-width": 1.5, ...more });

/// The mark of the i-th curve; curves of one colour have different ones.
export function mark(i, x, y, hollow) {
  const shape = marks[(i + Math.floor(i / colours)) % marks.length](Number(x.toFixed(2)), Number(y.toFixed(2)), 3.2);
  shape.setAttribute("stroke", curveColour(i));
  shape.setAttribute("fill", hollow ? "var(--surface)" : curveColour(i));
  return shape;
}

export function frame(width, x, y, axis, metric) {
  const [right, bottom] = [width - size.right, size.top + size.plot];
  const thin = { "stroke-width": 1 };
  const middle = size.top + size.plot / 2;
  return [
    ...x.ticks.flatMap((v) => [line([[x.at(v), size.top], [x.at(v), bottom]], grid, thin),
      text(tickLabel(v), { x: x.at(v).toFixed(1), y: bottom + 17, "text-anchor": "middle" })]),
    ...y.ticks.flatMap((v) => [line([[size.left, y.at(v)], [right, y.at(v)]], grid, thin),
      text(tickLabel(v), { x: size.left - 7, y: (y.at(v) + 4).toFixed(1), "text-anchor": "end" })]),
    line([[size.left, size.top], [size.left, bottom], [right, bottom]], muted),
    text(axisTitle(axis), { x: (size.left + right) / 2, y: bottom + 38, "text-anchor": "middle" }),
    text(axisTitle(metric), { x: 14, y: middle, "text-anchor": "middle",
      transform: `rotate(-90 14 ${middle})` })];
}

/// The entries in columns below the plot, names that are too long cut short, and their height.
export function legend(width, entries, top) {
  const columns = Math.max(1, Math.min(Math.floor((width - 30) / size.column), Math.ceil(entries.length / 4)));
  const rows = Math.ceil(entries.length / columns);
  const room = (width - 20) / columns;
  const letters = Math.floor((room - 40) / size.letter);
  const parts = entries.flatMap(({ symbol, label }, i) => {
    const [x, y] = [20 + room * Math.floor(i / rows), top + (i % rows) * size.line];
    const words = text(label.length > letters ? `${label.slice(0, letters - 1)}…` : label, { x: x + 18, y: y + 4 });
    if (label.length > letters) words.append(svg("title", {}, label));
    return [symbol(x, y), words];
  });
  return { parts, height: rows * size.line };
}
