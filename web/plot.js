// A log-log plot of error curves, on Chart.js.
import { axes, metrics, points, slopeLine, slopeName } from "./curve.js";
import { h, setText } from "./dom.js";
import { number } from "./format.js";

const shapes = ["circle", "rect", "triangle", "rectRot", "crossRot", "star", "rectRounded", "cross"];
export const colours = 8;  // --curve-0 ... in style.css

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/// Ticks of a log axis: decades, and between them as many steps as the range leaves room for.
export function logTicks(min, max) {
  const decades = Math.log10(max / min);
  if (!(decades > 0)) return [min];
  if (decades < 0.7) {
    const rough = (max - min) / 4;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((n) => n * power >= rough);
    const count = Math.floor(max / step) - Math.ceil(min / step) + 1;
    return Array.from({ length: count }, (_, i) => (Math.ceil(min / step) + i) * step);
  }
  const parts = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const every = Math.ceil(decades / 8);
  const ticks = [];
  for (let e = Math.floor(Math.log10(min)); e <= Math.log10(max); e += 1) {
    if (e % every !== 0) continue;
    for (const part of parts) {
      const value = Number(`${part}e${e}`);
      if (value >= min && value <= max) ticks.push(value);
    }
  }
  return ticks;
}

export function tickLabel(value) {
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e5 ? String(Number(value.toPrecision(3)))
    : value.toExponential().replace("e+", "e");
}

/// The ends of a log axis with room for its points.
export const ends = (values) => [Math.min(...values) / 1.15, Math.max(...values) * 1.15];

/// "render time (s)".
export const axisTitle = ({ label, unit }) => (unit ? `${label} (${unit})` : label);

function scale(title, values) {
  const [min, max] = ends(values);
  return {
    type: "logarithmic",
    min,
    max,
    title: { display: true, text: title, color: css("--muted") },
    grid: { color: css("--line"), borderColor: css("--muted") },
    ticks: { color: css("--muted"), autoSkip: false, maxRotation: 0, callback: tickLabel },
    afterBuildTicks: (axis) => {
      axis.ticks = logTicks(axis.min, axis.max).map((value) => ({ value }));
    },
  };
}

function curveSet(series, data, i) {
  const colour = css(`--curve-${i % colours}`);
  return {
    label: series.name,
    data,
    showLine: true,
    borderColor: colour,
    backgroundColor: colour,
    borderWidth: 1.5,
    pointStyle: shapes[i % shapes.length],
    pointRadius: 3.5,
    pointHoverRadius: 5,
    pointBorderColor: colour,
    pointBackgroundColor: data.map((p) => (p.floor ? css("--surface") : colour)),
  };
}

function slopeSet(data, slope) {
  return {
    label: `slope ${slopeName(slope)} (Monte Carlo)`,
    data,
    showLine: true,
    borderColor: css("--muted"),
    backgroundColor: "transparent",
    borderWidth: 1,
    borderDash: [6, 4],
    pointStyle: "line",
    pointRadius: 0,
    pointHitRadius: 0,
    pointHoverRadius: 0,
  };
}

function tooltip(axis, metric) {
  return {
    backgroundColor: css("--text"),
    titleColor: css("--surface"),
    bodyColor: css("--surface"),
    callbacks: {
      label: ({ dataset, raw }) => `${dataset.label}: ${metric.label} ${number(raw.y)}`
        + ` at ${number(raw.x)} ${axis.unit || axis.label}${raw.floor ? ", at the floor" : ""}`,
    },
  };
}

function settings(shown) {
  const { curves, series, axis, metric } = shown;
  const all = curves.flat();
  const line = slopeLine(curves, metric.slope);
  const datasets = curves.map((data, i) => curveSet(series[i], data, i));
  if (line.length > 0) datasets.push(slopeSet(line, metric.slope));
  const text = css("--text");
  return {
    data: { datasets },
    options: {
      animation: false,
      maintainAspectRatio: false,
      color: text,
      scales: all.length === 0 ? {} : {
        x: scale(axisTitle(axis), all.map((p) => p.x)),
        y: scale(axisTitle(metric), all.map((p) => p.y)),
      },
      plugins: {
        legend: { position: "bottom", labels: { color: text, usePointStyle: true, boxHeight: 7 } },
        tooltip: tooltip(axis, metric),
      },
    },
  };
}

function describe({ curves, series, axis, metric }) {
  const last = curves.map((c, i) => (c.length === 0 ? `${series[i].name}: no values`
    : `${series[i].name}: ${number(c[c.length - 1].y)} at ${number(c[c.length - 1].x)} ${axis.unit}`));
  return `${metric.label} against ${axis.label}, log-log. ${last.join("; ")}.`;
}

/// A plot of `series` ([{name, rows}], see parseCurve) with the axes' keys `x` and `y`.
/// `draw(series, x, y)` draws anew; it goes with `signal`.
export function plot(signal) {
  const canvas = h("canvas", { role: "img" });
  const empty = h("p", { className: "note", hidden: true });
  const floor = h("p", { className: "note", hidden: true },
    "Hollow points: the reference's own noise is reached there, so the error no longer measures "
    + "this picture alone.");
  const box = h("div", { className: "plot" }, canvas);
  let chart = null;
  let last = null;

  function draw(series, x, y) {
    last = [series, x, y];
    const axis = axes.find((a) => a.key === x);
    const metric = metrics.find((m) => m.key === y);
    const curves = metric ? series.map((s) => points(s.rows, x, y)) : [];
    const nothing = curves.every((c) => c.length === 0);
    box.hidden = nothing || !window.Chart;
    empty.hidden = !box.hidden;
    setText(empty, nothing ? "No errors have been measured."
      : "The plot library (/vendor/chart.js) was not served; the values are in the table.");
    floor.hidden = !curves.flat().some((p) => p.floor);
    canvas.setAttribute("data-curves", curves.filter((c) => c.length > 0).length);
    canvas.setAttribute("data-points", curves.flat().length);
    if (box.hidden) return;
    const shown = { series, curves, axis, metric };
    canvas.setAttribute("aria-label", describe(shown));
    const { data, options } = settings(shown);
    if (chart === null) {
      chart = new window.Chart(canvas, { type: "scatter", data, options });
    } else {
      chart.data = data;
      chart.options = options;
      chart.update();
    }
  }

  const redraw = () => last && draw(...last);
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", redraw, { signal });
  signal.addEventListener("abort", () => chart?.destroy());
  return { element: h("figure", { className: "plot-figure" }, box, empty, floor), draw };
}
