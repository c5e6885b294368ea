// The error plot with its switches, as the job view and the comparison show it.
import { axes, metrics, presentMetrics } from "./curve.js";
import { h, labelledSelect } from "./dom.js";
import { plot } from "./plot.js";

/// What is shown of `series`: {offered, x, y}, the metrics that any of them has, and the keys of the
/// axes: what `query` says; else the metric `preferred`, else the first that all of them have. `y` is
/// null if there is nothing.
export function chosenAxes(query, series, preferred) {
  const offered = metrics.filter((m) => series.some((s) => presentMetrics(s.rows).includes(m)));
  const shared = offered.find((m) => series.every((s) => presentMetrics(s.rows).includes(m)));
  const pick = (key) => offered.find((m) => m.key === key);
  return {
    offered,
    x: (axes.find((a) => a.key === query.get("x")) ?? axes[0]).key,
    y: (pick(query.get("y")) ?? pick(preferred) ?? shared ?? offered[0])?.key ?? null,
  };
}

/// A plot and its switches. `query` (URLSearchParams) holds the choice, `x` and `y`; it is changed
/// with the switches, then `changed()` is called. `show(series, preferred)` draws (see chosenAxes).
/// After it, `x` and `y` say what is shown.
export function curvePanel(query, changed, signal) {
  const figure = plot(signal);
  const x = labelledSelect("against", (value) => choose("x", value));
  const y = labelledSelect("Error", (value) => choose("y", value));
  const alone = h("button", { type: "button", className: "small", onclick: () => {
    location.hash += `${location.hash.includes("?") ? "&" : "?"}embed`;
  } }, "Figure alone");
  const switches = h("div", { className: "switches" }, y.element, x.element, alone);
  let shown = [];
  let wanted = null;

  const panel = {
    element: h("div", {}, switches, figure.element),
    x: axes[0].key,
    y: null,
    show(series, preferred = null) {
      shown = series;
      wanted = preferred;
      const { offered, ...keys } = chosenAxes(query, series, preferred);
      Object.assign(panel, keys);
      switches.hidden = panel.y === null;
      x.fill(axes, panel.x);
      y.fill(offered, panel.y);
      figure.draw(series, panel.x, panel.y);
    },
  };

  function choose(key, value) {
    query.set(key, value);
    panel.show(shown, wanted);
    changed();
  }
  return panel;
}
