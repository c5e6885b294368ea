// What a picture of numbers is: {width, height, channels, data, scale}. `data` holds half floats
// (Uint16Array) or floats (Float32Array), interleaved, the top row first; a value is its number times
// `scale`. Values are read in double, so that a scale outside a float's range loses nothing.
import { halfTable } from "./half.js";

/// A function from a place in `data` to its value.
export function reader({ data, scale }) {
  if (!(data instanceof Uint16Array)) return (k) => data[k] * scale;
  const numbers = halfTable();
  return (k) => numbers[data[k]] * scale;
}

/// The values of the pixel (x, y), one a channel; null outside the picture.
export function valuesAt(image, x, y) {
  const { width, height, channels } = image;
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return null;
  const read = reader(image);
  const first = (y * width + x) * channels.length;
  return channels.map((_, c) => read(first + c));
}

const most = 1 << 16;

/// The value below which the share `q` of what `of(values of a pixel)` gives lies, over the finite
/// ones that are not 0; large pictures are asked at evenly spread pixels. null: there are none.
export function quantile(image, q, of) {
  const read = reader(image);
  const n = image.channels.length;
  const pixels = image.width * image.height;
  const every = Math.max(1, Math.floor(pixels / most));
  const found = [];
  for (let i = 0; i < pixels; i += every) {
    const value = of(image.channels.map((_, c) => read(i * n + c)));
    if (Number.isFinite(value) && value !== 0) found.push(value);
  }
  if (found.length === 0) return null;
  return Float64Array.from(found).sort()[Math.floor((found.length - 1) * q)];
}
