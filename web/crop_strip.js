// One crop of several jobs side by side, at one exposure, with each job's time and error.
import { longest } from "./crop.js";
import { h, note, replace, setText } from "./dom.js";
import { aboutTimes } from "./equal_times.js";
import { seconds } from "./format.js";
import { stripPainter } from "./gl_strip.js";
import { cut } from "./pixels.js";

/// `show(state, sources, images, look, ratio)`: the state's crop of all images, where it asks for crops;
/// `ratio` is how many of the screen's pixels make a CSS pixel.
export function cropStrip(signal) {
  const draw = stripPainter(signal);
  const title = note();
  const times = h("div");
  const strip = h("div.crops");
  const element = h("section", { hidden: true }, h("h3", "Crops"), title, times, strip);
  let shown = {};
  let canvases = [];

  function makeFrames(sources) {
    canvases = sources.map(({ name }) => h("canvas", { role: "img", "aria-label": `Crop of ${name}` }));
    replace(strip, sources.map((s, i) => h("figure", canvases[i],
      h("figcaption", h("span", s.name), h("span", `${seconds(s.seconds)}, ${s.error || "no error measured"}`)))));
    replace(times, aboutTimes(sources.map((s) => s.seconds ?? 0)));
  }

  return {
    element,
    show({ mode, crop }, sources, images, look, ratio) {
      element.hidden = mode !== "crops" || images.includes(undefined);
      if (element.hidden) return;
      const now = JSON.stringify([crop, look, ratio]);
      if (shown.images === images && shown.now === now) return;
      if (shown.sources !== sources) makeFrames(sources);
      shown = { sources, images, now };
      const zoom = Math.max(1, Math.floor(longest / Math.max(crop.w, crop.h)));
      setText(title, `${crop.w} × ${crop.h} pixels at (${crop.x}, ${crop.y}), ${zoom} times as large. `
        + `Drag over the picture to choose others, at most ${longest} a side.`);
      draw(images.map((image, i) => ({ image: cut(image, crop), canvas: canvases[i], wide: crop.w * zoom })), look, ratio);
    },
  };
}
