// A viewer's controls: what is shown, how bright, and how large.
import { h, labelledSelect, setText, sign, small } from "./dom.js";
import { showKeys } from "./keys.js";

/// Exposure in stops, and back to the page's own choice.
export function exposureTools(actions) {
  const field = h("input", { type: "number", step: "0.1", "aria-label": "Exposure in stops", oninput: () => {
    if (field.value !== "") actions.setExposure(Number(field.value));
  } });
  const element = h("span.exposure.tools", h("label", "EV ", field),
    sign("Auto", "The page's own exposure", () => actions.setExposure(null)));
  return {
    element,
    show(value) {
      element.hidden = value === null;
      if (value !== null && document.activeElement !== field) field.value = Number(value.toFixed(2));
    },
  };
}

/// `actions`: {choose(key), setExposure(stops or null), zoomBy(factor), fit(), oneToOne()}.
export function viewerTools(actions) {
  const what = labelledSelect("Show", actions.choose);
  const exposure = exposureTools(actions);
  const level = h("output.muted");
  return {
    element: h("div.tools", what.element, exposure.element,
      h("span.tools",
        sign("−", "Zoom out", () => actions.zoomBy(0.5)), sign("+", "Zoom in", () => actions.zoomBy(2)),
        sign("Fit", "Show the whole picture", actions.fit),
        sign("1:1", "One picture pixel per screen pixel", actions.oneToOne), level),
      small("Keys", showKeys)),
    /// `stops` null: what is shown has no exposure.
    show({ options, chosen, stops, zoom }) {
      what.fill(options, chosen);
      exposure.show(stops);
      setText(level, `${Number((100 * zoom).toPrecision(3))} %`);
    },
  };
}
