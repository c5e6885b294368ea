// Numbers, times, names and states as text.
import { h } from "./dom.js";

export const thin = "\u202f";

/// `digits` significant digits, with an exponent where the number is very small or large.
export function significant(value, digits = 3) {
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size < 1e-3 || size >= 1e6) return value.toExponential(digits - 1).replace("e+", "e");
  return value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size))));
}

/// Integers in groups of three digits, other numbers with `digits` significant digits. null: an em dash.
export function number(value, digits = 3) {
  if (value === null || value === undefined) return "—";
  if (!Number.isInteger(value) || Math.abs(value) >= 1e15) return significant(value, digits);
  return String(value).replace(/\B(?=(\d{3})+$)/g, thin);
}

/// A value in the largest of `units` ([factor, name]) that is not above it: "19.9 M/s".
function scaled(value, units) {
  if (value === null || value === undefined) return "—";
  const [factor, name] = units.find(([f]) => value >= f) ?? units.at(-1);
  return `${factor === 1 ? number(value) : significant(value / factor)}${thin}${name}`;
}
const rate = (unit) => [[1e9, `G${unit}`], [1e6, `M${unit}`], [1e3, `k${unit}`], [1, unit]];

/// Seconds with their unit, precise: "0.412 s", "35.2 s", "412 s".
export const seconds = (value) => (value === null || value === undefined ? "—" : `${significant(value)}${thin}s`);

/// A waiting time, in at most two units: "8 s", "3 min 12 s", "2 h 5 min".
export function duration(value) {
  if (value === null || value === undefined) return "—";
  const s = Math.max(0, Math.round(value));
  if (s < 60) return `${s} s`;
  const [large, small] = [[86400, "d"], [3600, "h"], [60, "min"], [1, "s"]].filter(([n]) => n <= s);
  return `${Math.floor(s / large[0])} ${large[1]} ${Math.floor((s % large[0]) / small[0])} ${small[1]}`;
}

export const bytes = (value) => scaled(value, [
  [2 ** 40, "TiB"], [2 ** 30, "GiB"], [2 ** 20, "MiB"], [2 ** 10, "KiB"], [1, "B"]]);

/// An ISO instant in the local time zone: "2026-01-31 23:59:59"; empty stays empty.
export function when(iso) {
  if (!iso) return "";
  const date = new Date(iso);
  return new Date(date - 60_000 * date.getTimezoneOffset()).toISOString().slice(0, 19).replace("T", " ");
}

/// "cpu_seconds" -> "cpu seconds".
export const words = (key) => key.replaceAll("_", " ");

const units = [
  [/(^|_)per_cpu_second$/, (value) => scaled(value, rate("/CPU s"))],
  [/(^|_)per_second$/, (value) => scaled(value, rate("/s"))],
  [/(^|_)seconds$/, seconds], [/(^|_)bytes$/, bytes],
];

/// A value of a report, with the unit that its keys (innermost first) name.
export function quantity(value, keys) {
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value !== "number") return value === null ? "—" : String(value);
  const shows = keys.map((key) => units.find(([ending]) => ending.test(key))?.[1]);
  return (shows.find(Boolean) ?? number)(value);
}

/// A job file as text, with short lists on one line.
export const prettyJob = (job) => JSON.stringify(job, null, 2)
  .replace(/\[\n\s+([^[\]{}]*?)\n\s+\]/g, (_, items) => `[${items.replace(/\n\s+/g, " ")}]`);

/// "inspect", "path · bsdf": the integrator and the strategies in its slots.
export function integratorName(integrator) {
  if (typeof integrator === "string") return integrator;
  const slots = Object.values(integrator).filter((v) => v && typeof v === "object" && v.type);
  return [integrator.type, ...slots.map((s) => s.type)].join(" · ");
}

/// The title of a job: its label, else its scene.
export const jobTitle = (job) => job.label || job.scene;

/// A name in a figure's file, which allows 60 characters.
export const figureName = (text) => [...text].slice(0, 60).join("");

export const firstJob = (scenes) => ({
  scene: scenes[0] ?? "SCENE.glb", integrator: { type: "path" }, budget: { seconds: 30 }, reference: "auto",
});

export const shellQuote = (text) => `'${text.replaceAll("'", "'\\''")}'`;

/// A job without the keys that are null.
export const withoutNulls = (job) =>
  JSON.parse(JSON.stringify(job, (key, value) => (value === null ? undefined : value)));

/// The states of a job from the service (see getStates), by name; app.js fills it before any view is shown.
export const states = {};
/// done, failed, cancelled: the state changes only on request.
export const isTerminal = (state) => states[state].terminal;

export const badge = (state, phase) =>
  h("span", { className: `badge ${state}` }, phase && state === "running" ? `${state} · ${phase}` : state);

/// A progress bar with the remaining time; none for terminal states.
export const progressBar = (label, state, progress) => (!progress ? h("span.progress.empty") : h("span.progress",
  !isTerminal(state) && h("progress", { max: 1, value: progress.share, "aria-label": label }),
  h("span.remaining", remaining(state, progress))));

function remaining(state, progress) {
  if (isTerminal(state)) return `${seconds(progress.seconds)}, ${number(progress.iteration)} iterations`;
  const left = progress.remaining_seconds ?? null;
  return `${Math.floor(100 * progress.share)} %${left === null ? "" : `, ${duration(left)} left`}`;
}

/// "relmse 0.0123"; empty if there is none yet.
export const currentError = (progress) =>
  (Number.isFinite(progress?.error) ? `${progress.error_metric} ${number(progress.error)}` : "");
