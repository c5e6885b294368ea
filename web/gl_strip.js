// Many pictures drawn by one painter, each into a canvas of its own: a page may hold few WebGL contexts.
import { painter } from "./gl_draw.js";

/// A function that draws `pictures`, [{image, canvas, wide}], alike (see look.js): each `wide` CSS pixels wide,
/// of which one has `ratio` of the screen's. One a frame, fetched in the next, because many at once, or
/// waiting for one, would be a pause. The next call ends the one before; one that lost its context is made again
/// with a new one.
export function stripPainter(signal) {
  const hidden = new OffscreenCanvas(1, 1);
  let paint = null;
  let last = [];
  signal.addEventListener("abort", () => paint?.release());

  async function draw(...given) {
    last = given;
    const [pictures, look, ratio] = given;
    paint ??= painter(hidden, () => draw(...last));
    for (const { image, canvas, wide } of pictures) {
      const [width, height] = [wide, wide * image.height / image.width].map((n) => Math.round(n * ratio) || 1);
      Object.assign(hidden, { width, height });
      if (!paint.draw([{ ...look, image, from: 0, to: 1 }], { x: 0, y: 0, pace: image.width / width })) return;
      await new Promise(requestAnimationFrame);
      if (last !== given || signal.aborted) return;
      Object.assign(canvas, { width, height });
      canvas.style.width = `${wide}px`;
      canvas.getContext("bitmaprenderer").transferFromImageBitmap(hidden.transferToImageBitmap());
    }
  }
  return draw;
}
