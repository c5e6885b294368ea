// A job's picture: its layers in the viewer where there are any, else image.png, and why.
import { fileUrl } from "./api.js";
import { h, setText } from "./dom.js";
import { openLayers } from "./layers.js";
import { picture } from "./picture.js";
import { noViewer, viewer } from "./viewer.js";

/// `update(files, version, name, over)` follows the job's files ({name: {bytes}}); `version` says when
/// they changed, and `over` that they will no more. The viewer's state is in `query`; `strategies` is a place
/// for what belongs below all else.
export function jobPicture(id, query, signal) {
  const place = h("div");
  const note = h("p.note");
  const strategies = h("div");
  let pyramid = null;
  const plain = picture("The picture");
  let numbers;  // the viewer; null: it cannot be had
  let shown = null;

  const put = (element, why) => {
    if (place.firstChild !== element) place.replaceChildren(element);
    setText(note, why);
  };

  /// Most jobs have none.
  async function showStrategies(layers) {
    strategies.hidden = !layers.names.some((name) => name.includes("."));
    if (strategies.hidden) return;
    pyramid ??= (await import("./strategies.js")).strategies(query, signal, numbers.open);
    strategies.replaceChildren(pyramid.element);
    pyramid.show(layers);
  }

  async function update(files, version, name, over) {
    if (files["layers.json"]) numbers = numbers === undefined ? viewer(query, signal) : numbers;
    if (numbers && files["layers.json"]) {
      put(numbers.element, "");
      if (shown === version) return;
      shown = version;  // at once: a job's news come faster than its layers can be read
      try {
        const layers = await openLayers(id, signal);
        await numbers.show([{ name, layers }]);
        await showStrategies(layers);
      } catch (error) {
        shown = null;
        throw error;
      }
      return;
    }
    const image = files["image.png"];
    put(plain.element, !image ? "" : numbers === null ? noViewer
      : over ? "This job has no layers.json (written by newer versions); its tone-mapped image.png is shown."
        : "Preview: the latest tone-mapped image.png. Pixel values are available when the job ends.");
    plain.load(image ? fileUrl(id, "image.png", version) : null);
  }
  return { element: h("div", place, note), strategies, update };
}
