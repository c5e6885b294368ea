// The error plot with its switches, as the job view and the comparison show it.
import { axes, metrics, presentMetrics } from "./curve.js";
import { h } from "./dom.js";
import { plot } from "./plot.js";

function chooser(id, label, onchange) {
  const select = h("select", { id, onchange });
  return {
    select,
    element: h("span", { className: "choice" }, h("label", { htmlFor: id }, label), " ", select),
  };
}

function fill(select, options, value) {
  const same = options.length === select.options.length
    && options.every((o, i) => o.key === select.options[i].value);
  if (!same) {
    select.replaceChildren(...options.map((o) => h("option", { value: o.key }, o.label)));
  }
  select.value = value;
}

/// A plot and its switches. `query` (URLSearchParams) holds the choice, `x` and `y`; it is changed
/// with the switches, then `changed()` is called. `show(series, preferred)` draws: metrics that no
/// series has are not offered; without a choice the metric is `preferred`, else the first that all
/// of the series have. After it, `x` and `y` say what is shown (`y` null if there is nothing).
export function curvePanel(query, changed, signal) {
  const figure = plot(signal);
  const x = chooser("axis-x", "against", () => choose("x", x.select.value));
  const y = chooser("axis-y", "Error", () => choose("y", y.select.value));
  const switches = h("div", { className: "switches" }, y.element, x.element);
  let shown = [];
  let wanted = null;

  const panel = {
    element: h("div", {}, switches, figure.element),
    x: axes[0].key,
    y: null,
    show(series, preferred = null) {
      shown = series;
      wanted = preferred;
      const offered = metrics.filter((m) => series.some((s) => presentMetrics(s.rows).includes(m)));
      const shared = offered.find((m) => series.every((s) => presentMetrics(s.rows).includes(m)));
      const pick = (key) => offered.find((m) => m.key === key);
      panel.x = (axes.find((a) => a.key === query.get("x")) ?? axes[0]).key;
      panel.y = (pick(query.get("y")) ?? pick(preferred) ?? shared ?? offered[0])?.key ?? null;
      switches.hidden = panel.y === null;
      fill(x.select, axes, panel.x);
      fill(y.select, offered, panel.y);
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
