// A job's image.png as it is, where its values cannot be shown.
import { h } from "./dom.js";

/// A picture with the text `alt` and `caption` below it; it leads to the PNG itself. `load(url)` shows
/// another version of it without a flash; null: there is none yet.
export function picture(alt, caption) {
  const frame = h("a.frame", h("span.note", "no picture"));
  let current = null;
  async function load(url) {
    if (url === null || url === current) return;
    current = url;
    const image = h("img", { src: url, alt });
    await image.decode().catch(() => {});
    if (url !== current) return;
    frame.href = url;
    frame.replaceChildren(image);
  }
  return { element: h("figure", frame, caption && h("figcaption", caption)), load };
}
