// A picture of numbers is {width, height, channels, data, scale}: `data` are halves or floats, interleaved, the top row
// first, to be multiplied by `scale` in double. Some have an `extent`; those of errors their `kind` and their `mean`.

/// The values of the pixel (x, y), one a channel; null outside the picture.
export function valuesAt({ width, height, channels, data, scale }, x, y) {
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return null;
  const first = (y * width + x) * channels.length;
  return channels.map((_, c) => data[first + c] * scale);
}

/// The part {x, y, w, h} of a picture, in pixels, as a picture.
export function cut(image, { x, y, w, h }) {
  const n = image.channels.length;
  const data = new image.data.constructor(w * h * n);
  for (let row = 0; row < h; row += 1) {
    const first = ((y + row) * image.width + x) * n;
    data.set(image.data.subarray(first, first + w * n), row * w * n);
  }
  return { ...image, width: w, height: h, data };
}

// Enough for a percentile, and few enough that a large picture does not block the page.
const most = 1 << 14;

/// The quantiles `shares` of the finite non-zero values of `of(r, g, b)`; null if there are none.
function quantiles({ width, height, channels, data, scale }, shares, of) {
  const n = channels.length;
  const step = n * Math.max(1, Math.floor((width * height) / most));
  const found = [];
  for (let k = 0; k < data.length; k += step) {
    const value = of(data[k] * scale, data[k + 1] * scale, data[k + 2] * scale);
    if (Number.isFinite(value) && value !== 0) found.push(value);
  }
  const sorted = Float64Array.from(found).sort();
  return shares.map((q) => sorted[Math.floor((found.length - 1) * q)] ?? null);
}

/// The values that set a picture's brightness, [low, high], or null: for colours the 95th percentile of luminance; for
/// errors that of 99.5 % of all pixels; for other single channels the minimum and maximum.
export function extent(image) {
  if (image.channels.length > 1) {
    return [null, ...quantiles(image, [0.95], (r, g, b) => Math.max(0, 0.2126 * r + 0.7152 * g + 0.0722 * b))];
  }
  if (image.kind) return [null, ...quantiles(image, [0.995], Math.abs)];
  return quantiles(image, [0, 1], (v) => v);
}

const budget = 8;  // ms of a frame

/// A picture with blocks of `n` by `n` pixels averaged, and the `mean` of all its values. A large picture takes several
/// frames, so that none blocks the page.
export async function reduced({ width, height, channels, data, scale }, n) {
  const c = channels.length;
  const [w, h] = [width, height].map((size) => Math.ceil(size / n));
  const sums = new Float64Array(w * h * c);
  let until = performance.now() + budget;
  for (let y = 0, from = 0; y < height; y += 1) {
    if (performance.now() > until) {
      await new Promise(requestAnimationFrame);
      until = performance.now() + budget;
    }
    let to = Math.floor(y / n) * w * c;
    for (let x = 0, left = n; x < width; x += 1, left -= 1) {
      if (left === 0) [to, left] = [to + c, n];
      for (let k = 0; k < c; k += 1, from += 1) sums[to + k] += data[from];
    }
  }
  const mean = scale * sums.reduce((a, b) => a + b, 0) / data.length;
  const side = (size, i) => Math.min(n, size - i * n);
  const small = Float32Array.from(sums, (sum, i) => {
    const block = Math.floor(i / c);
    return sum / side(width, block % w) / side(height, Math.floor(block / w));
  });
  return { image: { width: w, height: h, channels, data: small, scale }, mean };
}
