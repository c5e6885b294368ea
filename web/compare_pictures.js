// The pictures of several jobs: those with layers of one size in one viewer, the others side by side.
import { fileUrl } from "./api.js";
import { append, h } from "./dom.js";
import { openLayers } from "./layers.js";
import { picture, zoomGroup } from "./picture.js";
import { noViewer, viewer } from "./viewer.js";

/// Frames stay while jobs run, so that the zoom stays too.
function gallery() {
  const group = zoomGroup();
  const frames = new Map();
  const element = h("div", { className: "gallery" });
  return {
    element,
    show(entries) {
      for (const { id, label, image } of entries) {
        if (!frames.has(id)) {
          frames.set(id, picture(`Picture of ${label}`, h("a", { href: `#/job/${id}` }, label), group));
        }
        frames.get(id).load(image);
      }
      const wanted = entries.map(({ id }) => frames.get(id).element);
      if (wanted.some((e, i) => element.children[i] !== e) || element.children.length > wanted.length) {
        element.replaceChildren(...wanted);
      }
    },
  };
}

/// What is said of the jobs that the viewer leaves out.
function reasons(plain, hasViewer) {
  if (!hasViewer) return [noViewer];
  return plain.filter((e) => e.image).map((e) => `${e.label}: ${
    e.layers ? "not of the first's size" : "no layers.json"}, so image.png is shown.`);
}

/// `show(jobs, labels)`: jobs are {id, state, files}. The viewer's state is in `query`.
export function comparePictures(query, changed, signal) {
  const numbers = viewer(query, changed, signal);
  const plainOnes = gallery();
  const notes = h("div", { className: "note" });
  const place = h("div");
  const opened = new Map();
  let shown = "";

  async function entryOf({ id, state, files }, label) {
    const file = (name) => files.find((f) => f.name === name);
    const png = file("image.png");
    const version = `${state.state} ${png?.bytes}`;
    const image = png ? fileUrl(id, "image.png", version) : null;
    if (!numbers || !file("layers.json")) return { id, label, image, version };
    if (opened.get(id)?.version !== version) opened.set(id, { version, layers: await openLayers(id, signal) });
    return { id, label, image, ...opened.get(id) };
  }

  return {
    element: h("div", {}, place, notes, plainOnes.element),
    async show(jobs, labels) {
      const entries = await Promise.all(jobs.map((job, i) => entryOf(job, labels[i])));
      const first = entries.find((e) => e.layers)?.layers;
      const fits = ({ layers }) => layers && layers.width === first.width && layers.height === first.height;
      const together = entries.filter(fits);
      const apart = entries.filter((e) => !fits(e));
      plainOnes.show(apart);
      notes.replaceChildren();
      append(notes, reasons(apart, numbers !== null).map((text) => h("p", {}, text)));
      const now = together.map((e) => `${e.id} ${e.version}`).join();
      if (together.length === 0 || now === shown) return;
      shown = now;
      if (!place.firstChild) place.append(numbers.element);
      await numbers.show(together.map(({ label, layers }) => ({ name: label, layers })));
    },
  };
}
