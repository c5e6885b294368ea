// The visible part of a picture: arithmetic only. A view is {zoom, x, y}: CSS pixels a pixel (null: all of it), and the
// middle, in [0, 1]. A crop is {x, y, w, h}, in whole pixels. `size` is the picture's and `box` the frame's.

const largestZoom = 256;
/// The zoom that shows the whole picture.
export const fitZoom = (size, box) => Math.min(box.width / size.width, box.height / size.height);
export const zoomOf = (view, size, box) => view.zoom ?? fitZoom(size, box);

/// The picture's point, in pixels, under the point (u, v), in CSS pixels, of the frame.
export function pointAt(view, size, box, u, v) {
  const zoom = zoomOf(view, size, box);
  return { x: view.x * size.width + (u - box.width / 2) / zoom, y: view.y * size.height + (v - box.height / 2) / zoom };
}

/// A view with as little empty space as possible.
function held({ zoom, x, y }, size, box) {
  const hold = (at, side) => {
    const half = Math.min(0.5, box[side] / 2 / zoomOf({ zoom }, size, box) / size[side]);
    return Math.min(1 - half, Math.max(half, at));
  };
  return { zoom, x: hold(x, "width"), y: hold(y, "height") };
}

/// The view after zooming with the point under (u, v) staying where it is; zooming out ends with the whole picture.
export function zoomTo(view, size, box, zoom, u = box.width / 2, v = box.height / 2) {
  const fit = fitZoom(size, box);
  if (zoom <= Math.min(1, fit)) return { zoom: fit <= 1 ? null : 1, x: 0.5, y: 0.5 };
  const next = Math.min(largestZoom, zoom);
  const { x, y } = pointAt(view, size, box, u, v);
  return held({ zoom: next, x: (x - (u - box.width / 2) / next) / size.width,
    y: (y - (v - box.height / 2) / next) / size.height }, size, box);
}

/// The view moved by (du, dv) CSS pixels.
export function moved(view, size, box, du, dv) {
  const zoom = zoomOf(view, size, box);
  return held({ ...view, x: view.x + du / zoom / size.width, y: view.y + dv / zoom / size.height }, size, box);
}

/// The longest side of a crop, in pixels.
export const longest = 256;
const within = (value, low, high) => Math.min(high, Math.max(low, Math.round(value)));

/// A crop that lies within the picture.
function cropIn({ x, y, w, h }, { width, height }) {
  const [wide, high] = [within(w, 1, Math.min(longest, width)), within(h, 1, Math.min(longest, height))];
  return { x: within(x, 0, width - wide), y: within(y, 0, height - high), w: wide, h: high };
}

/// `crop`, restricted to the picture; null: its middle.
export function settleCrop(crop, size) {
  const side = Math.min(64, Math.ceil(Math.min(size.width, size.height) / 4));
  return cropIn(crop ?? { x: (size.width - side) / 2, y: (size.height - side) / 2, w: side, h: side }, size);
}

/// The pixels of a drag between two points of the picture.
export function cropBetween(from, to, size) {
  const [x, y] = [Math.floor(Math.min(from.x, to.x)), Math.floor(Math.min(from.y, to.y))];
  return cropIn({ x, y, w: Math.ceil(Math.max(from.x, to.x)) - x, h: Math.ceil(Math.max(from.y, to.y)) - y }, size);
}

/// A crop moved by a tenth of its size to the `right` and `down`, each -1, 0 or 1.
export const movedCrop = (crop, right, down, size) => cropIn({ ...crop,
  x: crop.x + right * Math.ceil(crop.w / 10), y: crop.y + down * Math.ceil(crop.h / 10) }, size);

/// A crop a fifth larger (`step` 1) or smaller (-1).
export const scaledCrop = (crop, step, size) => cropIn({ ...crop,
  w: crop.w + step * Math.ceil(crop.w / 5), h: crop.h + step * Math.ceil(crop.h / 5) }, size);
