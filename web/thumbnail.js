// A small picture of a job, loaded when it comes into sight.
import { fileUrl } from "./api.js";
import { h } from "./dom.js";
import { isTerminal } from "./status.js";

const refreshSeconds = 10;

/// `update(entry)` says where the job stands. Its picture, once there is one, changes with the state, and
/// while it runs with time.
export function thumbnail() {
  const element = h("span.thumb");
  let shown = "";
  return {
    element,
    update({ id, state, picture, progress }) {
      if (!picture) return;
      const age = isTerminal(state) ? "" : Math.floor((progress?.seconds ?? 0) / refreshSeconds);
      const source = fileUrl(id, "image.png", `${state} ${age}`);
      if (source === shown) return;
      shown = source;
      const image = h("img", { loading: "lazy", decoding: "async", alt: "", src: source });
      // What is there stays until the next is loaded; a picture that cannot be had is none.
      image.onload = () => element.replaceChildren(image);
      image.onerror = () => image.remove();
      element.append(image);
    },
  };
}
