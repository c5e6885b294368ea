// A job's picture: its layers in the viewer where there are any, else image.png, and why.
import { fileUrl } from "./api.js";
import { h, setText } from "./dom.js";
import { openLayers } from "./layers.js";
import { picture, zoomGroup } from "./picture.js";
import { noViewer, viewer } from "./viewer.js";

/// `update(files, version, name, over)` follows the job's files ({name: {bytes}}); `version` says when
/// they changed, and `over` that they will no more. The viewer's state is in `query`.
export function jobPicture(id, query, changed, signal) {
  const place = h("div");
  const note = h("p", { className: "note", hidden: true });
  const plain = picture("The picture", "", zoomGroup());
  let numbers;  // the viewer; null: it cannot be had
  let shown = null;

  function sayWhy(text) {
    note.hidden = text === "";
    setText(note, text);
  }

  const put = (element) => {
    if (place.firstChild !== element) place.replaceChildren(element);
  };

  async function update(files, version, name, over) {
    const image = files["image.png"];
    if (files["layers.json"] && numbers !== null) {
      numbers ??= viewer(query, changed, signal);
      if (numbers) {
        put(numbers.element);
        if (shown === version) return;
        shown = version;  // at once: a job's news come faster than its layers can be read
        sayWhy("");
        try {
          await numbers.show([{ name, layers: await openLayers(id, signal) }]);
        } catch (error) {
          shown = null;
          throw error;
        }
        return;
      }
    }
    put(plain.element);
    sayWhy(!image ? "" : numbers === null
      ? noViewer
      : `${over ? "This job has no layers.json, which newer versions write" : "No layers.json has been written yet"}`
        + ": its tone-mapped image.png is shown.");
    plain.load(image ? fileUrl(id, "image.png", version) : null);
  }
  return { element: h("div", {}, place, note), update };
}
