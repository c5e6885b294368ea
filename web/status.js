// A job's state and progress, as every view shows them.
import { h, setText } from "./dom.js";
import { duration, number, seconds } from "./format.js";
import { isTerminal } from "./states.js";

/// A badge that says a state in words; `set(state, phase)`.
export function badge() {
  const element = h("span.badge");
  return {
    element,
    set(state, phase = "") {
      element.setAttribute("data-state", state);
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
