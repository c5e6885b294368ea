// A job's states: what can be done in which, and how every view shows them and the progress.
import { h, setText } from "./dom.js";
import { duration, number, seconds } from "./format.js";

export const states = ["running", "queued", "held", "interrupted", "cancelling", "done", "failed", "cancelled"];

const over = ["done", "failed", "cancelled"];
const waiting = ["queued", "running", "interrupted"];
const allowed = {
  cancel: [...waiting, "held"], hold: waiting, release: ["held"], priority: [...waiting, "held"],
  retry: ["failed", "cancelled"], extend: over, delete: over,
};

/// done, failed, cancelled: nothing happens any more, unless it is asked for.
export const isTerminal = (state) => over.includes(state);

/// Whether `action` (see above) makes sense in `state`; the service decides.
export const can = (action, state) => allowed[action].includes(state);

/// A badge that says a state in words; `set(state, phase)`.
export function badge() {
  const element = h("span.badge");
  return {
    element,
    set(state, phase = "") {
      element.className = `badge ${state}`;
      setText(element, phase && state === "running" ? `${state} · ${phase}` : state);
    },
  };
}

/// A bar with what remains beside it; `set(state, progress)`. It hides once nothing more happens.
export function progressBar(label) {
  const bar = h("progress", { max: 1, value: 0, "aria-label": label });
  const text = h("span.remaining");
  const element = h("span.progress", bar, text);
  return {
    element,
    set(state, progress) {
      bar.hidden = isTerminal(state) || !progress;
      if (!bar.hidden) bar.value = progress.share;
      setText(text, remaining(state, progress));
      element.classList.toggle("empty", bar.hidden && text.textContent === "");
    },
  };
}

function remaining(state, progress) {
  if (!progress) return "";
  if (isTerminal(state)) {
    return `${seconds(progress.seconds)}, ${number(progress.iteration)} iterations`;
  }
  const percent = `${Math.floor(100 * progress.share)} %`;
  return progress.remaining_seconds === null || progress.remaining_seconds === undefined
    ? percent : `${percent}, ${duration(progress.remaining_seconds)} left`;
}

/// "relmse 0.0123"; empty if there is none yet.
export const currentError = (progress) =>
  (progress && Number.isFinite(progress.error)
    ? `${progress.error_metric} ${number(progress.error)}` : "");
