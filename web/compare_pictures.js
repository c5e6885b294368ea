// The pictures of several jobs: those with layers of one size in one viewer, the others side by side.
import { fileUrl } from "./api.js";
import { h, replace } from "./dom.js";
import { openLayers } from "./layers.js";
import { picture } from "./picture.js";
import { currentError } from "./status.js";
import { noViewer, viewer } from "./viewer.js";

/// `show(jobs, labels)`: jobs are {id, state, progress, files}. The viewer's state is in `query`.
export function comparePictures(query, signal) {
  const numbers = viewer(query, signal);
  const apart = h("div.gallery");
  const place = h("div");
  const plain = new Map();  // stay while jobs run
  const opened = new Map();
  let shown = "";

  async function entryOf({ id, state, progress, files }, name) {
    const file = (wanted) => files.find((f) => f.name === wanted);
    const png = file("image.png");
    const version = `${state.state} ${png?.bytes}`;
    const entry = { id, name, version, image: png ? fileUrl(id, "image.png", version) : null,
      seconds: progress?.seconds, error: currentError(progress) };
    if (!numbers || !file("layers.json")) return entry;
    if (opened.get(id)?.version !== version) opened.set(id, { version, layers: await openLayers(id, signal) });
    return { ...entry, layers: opened.get(id).layers };
  }

  /// image.png of those that the viewer leaves out, and why.
  function showApart(entries) {
    for (const { id, name, image, layers } of entries) {
      const why = numbers === null ? noViewer
        : `${layers ? "Size differs from the first" : "No layers.json"}: image.png, each at its own exposure.`;
      if (!plain.has(id)) plain.set(id, picture(`Picture of ${name}`, [h("a", { href: `#/job/${id}` }, name), why]));
      plain.get(id).load(image);
    }
    replace(apart, entries.map(({ id }) => plain.get(id).element));
  }

  return {
    element: h("div", place, apart),
    async show(jobs, labels) {
      const entries = await Promise.all(jobs.map((job, i) => entryOf(job, labels[i])));
      const first = entries.find((e) => e.layers)?.layers;
      const fits = ({ layers }) => layers && layers.width === first.width && layers.height === first.height;
      const together = entries.filter(fits);
      showApart(entries.filter((e) => !fits(e)));
      const now = together.map((e) => `${e.id} ${e.version}`).join();
      if (together.length === 0 || now === shown) return;
      shown = now;
      if (!place.firstChild) place.append(numbers.element);
      await numbers.show(together);
    },
  };
}
