// A job's layers, read one at a time from layers.half as layers.json says.
import { getFile, getPart } from "./api.js";
import { extent } from "./pixels.js";

const tries = 4;

/// The layers of job `id` as they stand: {width, height, names, read(...names)}; `read` gives a picture
/// (see pixels.js) for each name, all of one generation, and the same ones when asked again, unless `forget(name)`
/// let one go.
export async function openLayers(id, signal) {
  async function readIndex() {
    const response = await getFile(id, "layers.json", signal);
    return { tag: response.headers.get("ETag"), ...await response.json() };
  }
  let index = await readIndex();
  const { width, height } = index;
  const kept = new Map();

  async function readLayer(name) {
    const layer = index.layers.find((l) => l.name === name);
    if (!layer) throw new Error(`This job has no layer "${name}" any more.`);
    const length = Math.max(...index.layers.map((l) => l.offset + l.bytes));
    const { data, total, tag } = await getPart(id, "layers.half", layer.offset, layer.bytes, signal);
    if (total !== length || data.byteLength !== 2 * width * height * layer.channels.length) return { tag: null };
    const picture = {
      width, height, channels: layer.channels, scale: layer.scale,
      data: new Float16Array(data),
    };
    return { tag, picture: { ...picture, extent: extent(picture) } };
  }

  function once(name) {
    if (!kept.has(name)) kept.set(name, readLayer(name));
    return kept.get(name);
  }

  /// A job that goes on replaces both files, one after the other. Parts belong together that come from
  /// one layers.half, of the lengths that the index tells, while the index stayed the same.
  async function read(...names) {
    for (let i = 0; i < tries; i += 1) {
      const anew = names.some((name) => !kept.has(name));
      try {
        const found = await Promise.all(names.map(once));
        const before = index.tag;
        if (anew) index = await readIndex();
        const [{ tag }] = found;
        const one = tag !== null && index.tag === before && found.every((f) => f.tag === tag);
        if (one) return found.map((f) => f.picture);
      } catch (error) {
        kept.clear();
        throw error;
      }
      kept.clear();
    }
    throw new Error("These layers changed while they were read.");
  }

  return { width, height, names: index.layers.map((l) => l.name), read, forget: (name) => kept.delete(name) };
}
