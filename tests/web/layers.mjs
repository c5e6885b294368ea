// layers.json and layers.half as a job leaves them, made here from functions of the pixel.

/// The 16 bits of the half float nearest to `value`; what is too large becomes infinite.
export function toHalf(value) {
  const sign = value < 0 || Object.is(value, -0) ? 0x8000 : 0;
  const size = Math.abs(value);
  if (Number.isNaN(value)) return 0x7e00;
  if (size === 0) return sign;
  if (size === Infinity) return sign | 0x7c00;
  const exponent = Math.max(-14, Math.floor(Math.log2(size)));
  let bits = Math.round((size / 2 ** exponent) * 1024);
  bits += (exponent + 14) * 1024;  // a carry runs into the exponent, as it should
  return sign | Math.min(bits, 0x7c00);
}

/// {"layers.json", "layers.half"} of a picture. `layers` are [{name, channels, scale, pixel(x, y)}];
/// pixel gives a value a channel.
export function layerFiles(width, height, layers) {
  const parts = [];
  const index = { width, height, layers: [] };
  let offset = 0;
  for (const { name, channels, scale = 1, pixel } of layers) {
    const part = Buffer.alloc(2 * width * height * channels.length);
    let at = 0;
    for (let y = 0; y < height; y += 1) {
      for (let x = 0; x < width; x += 1) {
        for (const value of pixel(x, y)) at = part.writeUInt16LE(toHalf(value / scale), at);
      }
    }
    index.layers.push({ name, channels, offset, bytes: part.length, scale });
    parts.push(part);
    offset += part.length;
  }
  return { "layers.json": JSON.stringify(index), "layers.half": Buffer.concat(parts) };
}
