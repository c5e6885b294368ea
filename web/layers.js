// A job's layers, read one at a time from layers.half as layers.json says.
import { getJson, getPart } from "./api.js";

const tries = 3;

function check(layer, width, height) {
  const expected = 2 * width * height * layer.channels.length;
  if (layer.bytes !== expected || layer.offset < 0) {
    throw new Error(`layers.json: layer "${layer.name}" has ${layer.bytes} bytes, not ${expected}.`);
  }
}

/// The layers of job `id` as they stand: {width, height, names, read(name)}; `read` gives a picture
/// (see pixels.js), and the same one when asked again.
export async function openLayers(id, signal) {
  const readIndex = () => getJson(id, "layers.json", signal);
  const index = await readIndex();
  const { width, height } = index;
  const kept = new Map();

  /// A running job replaces both files, one after the other. What was read between two equal
  /// indices belongs to them.
  async function readOnce(name) {
    let before = index;
    for (let i = 0; i < tries; i += 1) {
      const layer = before.layers.find((l) => l.name === name);
      if (!layer) break;
      check(layer, width, height);
      const data = new Uint16Array(await getPart(id, "layers.half", layer.offset, layer.bytes, signal));
      const after = await readIndex();
      if (JSON.stringify(after) === JSON.stringify(before)) {
        return { width, height, channels: layer.channels, data, scale: layer.scale };
      }
      before = after;
    }
    throw new Error(`Layer "${name}" changed while it was read.`);
  }

  return {
    width,
    height,
    names: index.layers.map((l) => l.name),
    read(name) {
      if (!kept.has(name)) {
        const reading = readOnce(name);
        kept.set(name, reading);
        reading.catch(() => kept.delete(name));
      }
      return kept.get(name);
    },
  };
}
