// A viewer's controls: what is shown, how bright, and how large.
import { h, labelledSelect, setText } from "./dom.js";

const button = (text, label, onclick) =>
  h("button", { type: "button", className: "small", title: label, "aria-label": label, onclick }, text);

/// Exposure in stops: a slider, a number for what lies beyond it, and back to the page's own choice.
function exposureTools(actions) {
  const input = (type, more) => h("input", {
    type, step: "0.1", ...more,
    oninput: (event) => {
      if (event.target.value !== "") actions.setExposure(Number(event.target.value));
    },
  });
  const slider = input("range", { min: "-16", max: "16", "aria-label": "Exposure" });
  const field = input("number", { "aria-label": "Exposure in stops" });
  const element = h("span", { className: "exposure" }, h("span", {}, "EV"), slider, field,
    button("Auto", "The page's own exposure", () => actions.setExposure(null)));
  return {
    element,
    show(value) {
      element.hidden = value === null;
      if (value === null) return;
      const text = String(Number(value.toFixed(2)));
      slider.value = text;
      if (document.activeElement !== field) field.value = text;
    },
  };
}

const keyHelp = [
  ["e, E", "brighter, darker by half a stop"], ["[, ]", "the layer before, after"],
  ["+, −, wheel", "zoom; the wheel once the picture has the focus"], ["arrows, drag", "move"],
  ["0 or f, o", "fit; one to one"], ["1 … 9", "of several pictures: that one"],
  [", .", "the line between two pictures"],
];

/// `actions`: {choose(key), setExposure(stops or null), zoomBy(factor), fit(), oneToOne()}.
export function viewerTools(actions) {
  const what = labelledSelect("Show", actions.choose);
  const exposure = exposureTools(actions);
  const level = h("output", { className: "muted" });
  const keys = h("details", { className: "keys-help" }, h("summary", {}, "Keys"),
    h("dl", {}, keyHelp.map(([key, text]) => h("div", {}, h("dt", {}, key), h("dd", {}, text)))));
  return {
    element: h("div", {},
      h("div", { className: "tools" }, what.element, exposure.element,
        h("span", { className: "tools" },
          button("−", "Zoom out", () => actions.zoomBy(0.5)), button("+", "Zoom in", () => actions.zoomBy(2)),
          button("Fit", "Show the whole picture", actions.fit),
          button("1:1", "One pixel of the picture on one of the screen", actions.oneToOne), level)),
      keys),
    /// `stops` null: what is shown has no exposure.
    show({ options, chosen, stops, zoom }) {
      what.fill(options, chosen);
      exposure.show(stops);
      setText(level, `${Number((100 * zoom).toPrecision(3))} %`);
    },
  };
}
