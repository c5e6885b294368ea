// What a sweep's answers (docs/sweeps-and-reports.md) say in words and columns: arithmetic and text only.
import { number, significant } from "./format.js";

const thin = "\u202f";

/// "0.0123 (0.011–0.014)": an estimate with its interval, if it has one.
export function estimateText(estimate, digits = 3) {
  if (!estimate) return "—";
  const interval = estimate.low === undefined ? ""
    : ` (${significant(estimate.low, digits)}–${significant(estimate.high, digits)})`;
  return significant(estimate.value, digits) + interval;
}

export const gainText = (gain) => (gain
  ? `${gain.at_least ? "> " : ""}${significant(gain.value, 3)}×${gain.low === undefined ? ""
    : ` (${significant(gain.low, 3)}–${significant(gain.high, 3)})`}` : "—");

/// What an interval says of "no difference", 1: "better", "worse", or "" where it cannot tell.
export function verdict(gain) {
  if (!gain) return "";
  if (gain.at_least) return gain.value > 1 ? "better" : "";
  if (gain.low > 1) return "better";
  return gain.high < 1 ? "worse" : "";
}

/// The last part of each pointer, longer where two end alike.
export function settingNames(pointers) {
  const ending = (pointer, parts) => pointer.split("/").slice(1).slice(-parts).join("/");
  return pointers.map((pointer) => {
    for (let parts = 1; ; parts += 1) {
      const name = ending(pointer, parts);
      const alone = pointers.every((other) => other === pointer || ending(other, parts) !== name);
      if (alone || `/${name}` === pointer) return name;
    }
  });
}

export const settingText = (value) => (typeof value === "string" ? value : JSON.stringify(value));

/// The pointers whose values differ among `cells`.
export const varyingSettings = (pointers, cells) => pointers.filter((pointer) =>
  new Set(cells.map((cell) => JSON.stringify(cell.settings[pointer]))).size > 1);

/// A cell among `cells`, by the settings in which they differ.
export function cellNames(answers, cells) {
  const pointers = varyingSettings(answers.settings, cells);
  const names = settingNames(pointers);
  return new Map(cells.map((cell) => [cell.cell,
    pointers.map((p, i) => `${names[i]} ${settingText(cell.settings[p])}`).join(", ") || "the job"]));
}

/// The time to an error in words: reached, or not, and by how many runs.
export function timeText(to, runs) {
  if (to.time) return `${to.at_most ? "≤ " : ""}${estimateText(to.time)}${thin}s`;
  if (to.reached > 0) return `reached by ${to.reached} of ${runs} runs`;
  return to.at_least ? `not reached in ${significant(to.at_least)}${thin}s` : "not reached";
}

export const errorText = (at, runs) => (at.error
  ? estimateText(at.error) : `measured in ${at.reached} of ${runs} runs`);

/// When a preparation has paid, in words.
export function paysText(pays, known) {
  if (!known) return "not known";
  if (!pays) return "not within the measured time";
  return pays.from_the_start ? "at once" : `after ${significant(pays.seconds)}${thin}s`;
}

/// The bias that the runs show, as a share of the squared error: an interval above 0 is a bias.
export function biasText(cell) {
  const bias = cell.bias_between_runs ?? cell.bias_squared;
  if (!bias) return "—";
  if (bias.low === undefined) return "needs several runs";
  return bias.low > 0 ? `biased: ${estimateText(bias)}` : `none seen (below ${significant(Math.max(bias.high, 0))})`;
}

/// A few of the cells by name, and how many more.
function someOf(cells, names, most = 3) {
  const text = cells.slice(0, most).map((c) => names.get(c)).join("; ");
  return cells.length > most ? `${text} and ${cells.length - most} more` : text;
}

/// The front in sentences: who leads from when to when.
export const frontParts = (front, names) => front.map((part) => ({
  ...part,
  text: `${significant(part.from)} to ${significant(part.to)}${thin}s`,
  name: names.get(part.cell),
  doubts: [
    part.tied.length > 0 && `tied with ${someOf(part.tied, names)}`,
    !part.supported && "at the reference's own noise: not supported",
  ].filter(Boolean).join("; "),
}));

export const charges = [
  { key: "render", label: "rendering alone" },
  { key: "warm", label: "with preparation, cache warm" },
  { key: "cold", label: "with preparation, cache cold" },
];

/// The seconds that a charge adds to a cell's times; null: not known.
export const charged = (cell, charge) => (charge === "render" ? 0 : cell.preparation[charge]);

/// A cell's mean curve: {x, y, low, high, floor}, on the time axis of `charge`; empty if unknown.
export function bandPoints(cell, charge) {
  const shift = charged(cell, charge);
  if (shift === null) return [];
  return cell.curve.map(([time, y, low, high, floor]) => ({ x: time + shift, y, low, high, floor: floor === 1 }));
}

export const count = (n, one, many = `${one}s`) => `${number(n)} ${n === 1 ? one : many}`;
