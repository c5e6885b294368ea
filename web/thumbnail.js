// Small pictures of jobs: loaded when they come into sight, and only where the job has a picture.
import { fileUrl, getJob, isTerminal } from "./api.js";
import { h } from "./dom.js";

const refreshSeconds = 10;

/// Thumbnails that watch their own visibility until `signal` is aborted. `make()` gives an element;
/// `update(element, job)` says which job it shows and where that stands.
export function thumbnails(signal) {
  const known = new WeakMap();
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const thumb = known.get(entry.target);
      thumb.visible = entry.isIntersecting;
      refresh(entry.target, thumb);
    }
  }, { rootMargin: "200px" });
  signal.addEventListener("abort", () => observer.disconnect());

  /// What the picture can depend on: it changes with the state, and in a running job with time.
  function version({ state, progress }) {
    return isTerminal(state) || !progress
      ? state : `${state} ${Math.floor(progress.seconds / refreshSeconds)}`;
  }

  async function refresh(element, thumb) {
    const wanted = version(thumb.job);
    if (!thumb.visible || thumb.shown === wanted || thumb.job.state === "queued") return;
    thumb.shown = wanted;
    try {
      const { files } = await getJob(thumb.job.id, signal);
      const file = files.find((f) => f.name === "image.png");
      if (!file) return;
      const url = fileUrl(thumb.job.id, file.name, `${wanted} ${file.bytes}`);
      const image = h("img", { src: url, alt: "", decoding: "async" });
      await image.decode();
      element.replaceChildren(image);
    } catch {
      thumb.shown = null;  // the list itself says what is wrong; try again with its next state
    }
  }

  return {
    make: () => h("span", { className: "thumb" }),
    update(element, job) {
      const thumb = known.get(element);
      if (thumb) {
        thumb.job = job;
        refresh(element, thumb);
      } else {
        known.set(element, { job, visible: false, shown: null });
        observer.observe(element);
      }
    },
  };
}
