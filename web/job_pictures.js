// Jobs' pictures: layers of equal size together in the viewer, else their image.png with the reason.
import { fileUrl, getFile, getPart } from "./api.js";
import { button, h, update } from "./dom.js";
import { currentError } from "./format.js";
import { extent } from "./pixels.js";
import { viewer } from "./viewer.js";

const tries = 4;

/// The layers of a job: {width, height, names, read(...names)}; `read` returns a picture (see pixels.js) for each name,
/// all of one generation, cached until `forget(name)`.
async function openLayers(id, signal) {
  const readIndex = () => getFile(id, "layers.json", signal)
    .then(async (response) => ({ tag: response.headers.get("ETag"), ...await response.json() }));
  let index = await readIndex();
  const { width, height } = index;
  const kept = new Map();

  async function readLayer(name) {
    const layer = index.layers.find((l) => l.name === name);
    if (!layer) throw new Error(`This job has no layer "${name}" any more.`);
    const length = Math.max(...index.layers.map((l) => l.offset + l.bytes));
    const { data, total, tag } = await getPart(id, "layers.half", layer.offset, layer.bytes, signal);
    if (total !== length || data.byteLength !== 2 * width * height * layer.channels.length) return { tag: null };
    const picture = { width, height, channels: layer.channels, scale: layer.scale, data: new Float16Array(data) };
    return { tag, picture: { ...picture, extent: extent(picture) } };
  }

  const once = (name) => kept.get(name) ?? kept.set(name, readLayer(name)).get(name);
  function forget(error) {
    kept.clear();
    throw error;
  }

  /// A running job replaces both files, one after the other. Parts are consistent if they come from one layers.half,
  /// have the lengths in the index, and the index stayed the same.
  async function read(...names) {
    for (let i = 0; i < tries; i += 1) {
      const anew = names.some((name) => !kept.has(name));
      const found = await Promise.all(names.map(once)).catch(forget);
      const before = index.tag;
      if (anew) index = await readIndex().catch(forget);
      const [{ tag }] = found;
      if (tag !== null && index.tag === before && found.every((f) => f.tag === tag)) return found.map((f) => f.picture);
      kept.clear();
    }
    throw new Error("These layers changed while they were read.");
  }

  return { width, height, names: index.layers.map((l) => l.name), read, forget: (name) => kept.delete(name) };
}

/// `show(jobs)` takes jobs with a `name`; it returns the first one's layers if the shown layers changed, else null.
/// `describe(job)` gives {alt, caption} of an image.png: of its `image`, its `layers`, and if they are `drawable` here.
export function jobPictures(query, signal, describe) {
  const [place, apart] = [h("div"), h("div.gallery")];
  const opened = new Map();  // by id: {version, layers}, a promise
  let numbers;  // the viewer, once there are layers; null: no WebGL 2
  let shown = "";

  async function entryOf(job) {
    const { id, state, progress, files } = job;
    const file = (wanted) => files.find((f) => f.name === wanted);
    // image.png is written after the layers, and unlike theirs its size changes with its content.
    const version = `${state.state} ${file("image.png")?.bytes}`;
    const entry = { ...job, version, image: file("image.png") && fileUrl(id, "image.png", version),
      seconds: progress?.seconds, error: currentError(progress), drawable: numbers !== null };
    if (!numbers || !file("layers.json")) return entry;
    if (opened.get(id)?.version !== version) opened.set(id, { version, layers: openLayers(id, signal) });
    return { ...entry, layers: await opened.get(id).layers.catch((error) => {
      opened.delete(id);
      throw error;
    }) };
  }

  const plain = ({ image }, { alt, caption }) => h("figure",
    h("a.frame", { href: image }, image ? h("img", { src: image, alt }) : h("span.note", "no picture")),
    h("figcaption", caption));

  return {
    element: h("div", place, apart),
    open: (key) => numbers.open(key),
    /// The button for a figure of a paper; `spec(screen)` gives its file, from what the viewer shows.
    figureButton: (spec) => button("Figure …", async () =>
      (await import("./paper_figure.js")).showFigure(spec(numbers?.screen() ?? {}))),
    async show(jobs) {
      const drawable = jobs.some(({ files }) => files.some((f) => f.name === "layers.json"));
      if (drawable && numbers === undefined) numbers = viewer(query, signal);
      const entries = await Promise.all(jobs.map(entryOf));
      const first = entries.find((e) => e.layers)?.layers;
      const fits = ({ layers }) => layers && layers.width === first.width && layers.height === first.height;
      const together = entries.filter(fits);
      update(apart, entries.filter((e) => !fits(e)).map((e) => plain(e, describe(e))));
      const now = together.map((e) => `${e.id} ${e.version}`).join();
      if (now === shown || together.length === 0) return null;
      shown = now;
      if (!place.firstChild) place.append(numbers.element);
      await numbers.show(together);
      return first;
    },
  };
}
