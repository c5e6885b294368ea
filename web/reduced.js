// A picture of numbers made small, so that many can be held.

const budget = 8;  // ms of a frame

/// `image` (see pixels.js) with blocks of `n` by `n` pixels averaged, those at its right and lower border over what
/// there is; and the `mean` of all its values. A large one takes several frames, so that none is a pause.
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
