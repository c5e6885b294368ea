// The controls for several pictures: one at a time, two split by a line, their difference, or crops.
import { errorKinds } from "./error_picture.js";
import { h, labelledSelect } from "./dom.js";

const names = { one: "one at a time", split: "split", difference: "difference",
  crops: "crops side by side" };

/// `change(values)` is called with what the reader changes of a state (see viewer_state.js).
export function modeTools(change) {
  const mode = labelledSelect("Pictures", (value) => change({ mode: value }));
  const left = labelledSelect("", (value) => change({ left: Number(value) }));
  const right = labelledSelect("", (value) => change({ right: Number(value) }));
  const by = labelledSelect("by", (value) => change({ by: value }));
  const and = h("span.muted");
  const element = h("div.tools", { hidden: true },
    mode.element, left.element, and, right.element, by.element);
  left.element.lastChild.ariaLabel = "First picture";
  right.element.lastChild.ariaLabel = "Second picture";
  return {
    element,
    show(state, labels) {
      element.hidden = labels.length < 2;
      if (element.hidden) return;
      const options = labels.map((label, i) => ({ key: String(i), label: `${i + 1} ${label}` }));
      mode.fill(Object.entries(names).map(([key, label]) => ({ key, label })), state.mode);
      left.fill(options, String(state.left));
      right.fill(options, String(state.right));
      by.fill(errorKinds.map(({ key, label }) => ({ key, label })), state.by);
      right.element.hidden = !["split", "difference"].includes(state.mode);
      and.hidden = right.element.hidden;
      and.textContent = state.mode === "split" ? "left of" : "subtracted from";
      by.element.hidden = state.mode !== "difference";
    },
  };
}
