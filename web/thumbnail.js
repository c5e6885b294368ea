// A small picture of a job, loaded when it comes into sight.
import { fileUrl } from "./api.js";
import { h } from "./dom.js";
import { isTerminal } from "./status.js";

const refreshSeconds = 10;

/// `update(entry)` says where the job stands. Its picture changes with the state, and while it runs with
/// time; before there is progress there is none.
export function thumbnail() {
  const element = h("span.thumb");
  let shown = "";
  return {
    element,
    update({ id, state, progress }) {
      if (!progress?.iteration) return;
      const age = isTerminal(state) ? "" : Math.floor(progress.seconds / refreshSeconds);
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
