// The rectangle of a picture that is looked at closely: arithmetic only. A crop is {x, y, w, h}, in whole
// pixels; `size` is the picture's {width, height}.

/// The longest side of a crop, in pixels.
export const longest = 256;

const within = (value, low, high) => Math.min(high, Math.max(low, Math.round(value)));

/// A crop that lies within the picture.
function held({ x, y, w, h }, { width, height }) {
  const [wide, high] = [within(w, 1, Math.min(longest, width)), within(h, 1, Math.min(longest, height))];
  return { x: within(x, 0, width - wide), y: within(y, 0, height - high), w: wide, h: high };
}

/// `crop` as it can be shown; null: the middle of the picture.
export function settleCrop(crop, size) {
  const side = Math.min(64, Math.ceil(Math.min(size.width, size.height) / 4));
  return held(crop ?? { x: (size.width - side) / 2, y: (size.height - side) / 2, w: side, h: side }, size);
}

/// The pixels that a drag touches between two points of the picture.
export function cropBetween(from, to, size) {
  const [x, y] = [Math.floor(Math.min(from.x, to.x)), Math.floor(Math.min(from.y, to.y))];
  return held({ x, y, w: Math.ceil(Math.max(from.x, to.x)) - x, h: Math.ceil(Math.max(from.y, to.y)) - y }, size);
}

/// Moved by a tenth of itself to the `right` and `down`, each -1, 0 or 1.
export const movedCrop = (crop, right, down, size) => held({ ...crop,
  x: crop.x + right * Math.ceil(crop.w / 10), y: crop.y + down * Math.ceil(crop.h / 10) }, size);

/// A fifth larger (`step` 1) or smaller (-1).
export const scaledCrop = (crop, step, size) => held({ ...crop,
  w: crop.w + step * Math.ceil(crop.w / 5), h: crop.h + step * Math.ceil(crop.h / 5) }, size);
