// A small PNG, made here so that the fixtures need no files.
import { deflateSync } from "node:zlib";

/// CRC-32 of each byte, for the next.
const remainders = Int32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  return crc;
});

/// CRC-32 as PNG wants it (ISO 3309).
function crc32(data) {
  let crc = -1;
  for (const byte of data) crc = (crc >>> 8) ^ remainders[(crc ^ byte) & 255];
  return ~crc >>> 0;
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const size = Buffer.alloc(4);
  const check = Buffer.alloc(4);
  size.writeUInt32BE(data.length);
  check.writeUInt32BE(crc32(body));
  return Buffer.concat([size, body, check]);
}

/// An RGB picture of width x height; `pixel(x, y)` gives three values in [0, 255].
export function png(width, height, pixel) {
  const rows = Buffer.alloc(height * (1 + 3 * width));
  for (let y = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1) {
      pixel(x, y).forEach((value, c) => {
        rows[y * (1 + 3 * width) + 1 + 3 * x + c] = Math.max(0, Math.min(255, value));
      });
    }
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

/// Noise in [0, 1) from a fixed seed (Marsaglia's xorshift32).
export function noise(seed) {
  let state = seed;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}

const wallColour = (u) => (u < 0.2 ? [180, 60, 50] : u > 0.8 ? [60, 140, 70] : [190, 185, 175]);
const lightOf = (u, v) => (Math.hypot(u - 0.5, v - 0.05) < 0.12 ? 2 : 0.35 + 0.6 * Math.exp(-4 * v * v));

/// A room with a lit wall, more or less noisy.
export function room(width, height, grain, seed) {
  const random = noise(seed);
  return png(width, height, (x, y) => {
    const [u, v] = [x / width, y / height];
    return wallColour(u).map((c) => c * lightOf(u, v) + 255 * grain * (random() - 0.5));
  });
}

/// The same room as radiance: a function of the pixel.
export function radiance(width, height, grain, seed) {
  const random = noise(seed);
  return (x, y) => {
    const [u, v] = [x / width, y / height];
    const wall = lightOf(u, v) === 2 ? [17, 12, 4] : wallColour(u).map((c) => (c / 255) ** 2.2 * lightOf(u, v));
    return wall.map((c) => c * (1 + grain * (random() - 0.5)));
  };
}
