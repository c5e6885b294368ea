// One crop of several jobs side by side, at one exposure, with each job's time and error.
import { longest } from "./crop.js";
import { h, note, replace, setText } from "./dom.js";
import { aboutTimes } from "./equal_times.js";
import { seconds } from "./format.js";
import { painter } from "./gl_draw.js";
import { cut } from "./pixels.js";

/// `show(state, sources, images, look, ratio)`: the state's crop of all images, where it asks for crops;
/// `ratio` is how many of the screen's pixels make a CSS pixel.
export function cropStrip(signal) {
  const hidden = new OffscreenCanvas(1, 1);
  const title = note();
  const times = h("div");
  const strip = h("div.crops");
  const element = h("section", { hidden: true }, h("h3", "Crops"), title, times, strip);
  let paint = null;
  let shown = {};
  let canvases = [];
  signal.addEventListener("abort", () => paint?.release());

  function makeFrames(sources) {
    canvases = sources.map(({ name }) => h("canvas", { role: "img", "aria-label": `Crop of ${name}` }));
    replace(strip, sources.map((s, i) => h("figure", canvases[i],
      h("figcaption", h("span", s.name), h("span", `${seconds(s.seconds)}, ${s.error || "no error measured"}`)))));
    replace(times, aboutTimes(sources.map((s) => s.seconds ?? 0)));
  }

  function draw(image, crop, scale, look) {
    const [width, height] = [crop.w, crop.h].map((n) => Math.round(n * scale));
    Object.assign(hidden, { width, height });
    paint.draw([{ ...look, image: cut(image, crop), from: 0, to: 1 }], { x: 0, y: 0, pace: crop.w / width });
  }

  function fetchInto(canvas, wide) {
    Object.assign(canvas, { width: hidden.width, height: hidden.height });
    canvas.style.width = `${wide}px`;
    canvas.getContext("bitmaprenderer").transferFromImageBitmap(hidden.transferToImageBitmap());
  }

  return {
    element,
    /// One crop a frame, fetched in the next, because many at once, or waiting for one, would be a pause.
    async show({ mode, crop }, sources, images, look, ratio) {
      element.hidden = mode !== "crops" || images.includes(undefined);
      if (element.hidden) return;
      const now = JSON.stringify([crop, look, ratio]);
      if (shown.images === images && shown.now === now) return;
      if (shown.sources !== sources) makeFrames(sources);
      const mine = { sources, images, now };
      shown = mine;
      paint ??= painter(hidden, () => { shown = {}; });
      const zoom = Math.max(1, Math.floor(longest / Math.max(crop.w, crop.h)));
      setText(title, `${crop.w} × ${crop.h} pixels at (${crop.x}, ${crop.y}), ${zoom} times as large. `
        + `Drag over the picture to choose others, at most ${longest} a side.`);
      for (let i = 0; i < images.length; i += 1) {
        draw(images[i], crop, zoom * ratio, look);
        await new Promise(requestAnimationFrame);
        if (shown !== mine) return;
        fetchInto(canvases[i], crop.w * zoom);
      }
    },
  };
}
