// A colour map with the values it stands for.
import { colourMap, steps } from "./colour_maps.js";
import { h, setText } from "./dom.js";
import { significant } from "./format.js";

const parts = 4;

/// `show(look, title)`: a look of false colours (see look.js); others hide it.
export function colourBar() {
  const canvas = h("canvas", { width: steps, height: 1, role: "img" });
  const labels = Array.from({ length: parts + 1 }, () => h("span"));
  const title = h("span.bar-title");
  const element = h("div.colour-bar", { hidden: true }, title, canvas,
    h("div.bar-labels", labels));
  let painted = null;
  return {
    element,
    show(look, text) {
      element.hidden = look.look !== "false";
      if (element.hidden) return;
      setText(title, text);
      const at = (i) => look.low + ((look.high - look.low) * i) / parts;
      labels.forEach((label, i) => setText(label, significant(at(i))));
      canvas.setAttribute("aria-label", `Colours from ${significant(at(0))} to ${significant(at(parts))}`);
      if (painted === look.map) return;
      painted = look.map;
      canvas.getContext("2d")
        .putImageData(new ImageData(colourMap(look.map), steps, 1), 0, 0);
    },
  };
}
