// report.json as readable tables, whatever keys it has; units come from the keys.
import { h, table } from "./dom.js";
import { quantity, words } from "./format.js";

/// The numbers and words in a report: [{keys, value}], the innermost key first; lists of plain values
/// count as one, and the records of a list are numbered from 1.
export function leaves(value, keys = []) {
  if (value === null || typeof value !== "object") return [{ keys, value }];
  if (Array.isArray(value) && value.every((v) => v === null || typeof v !== "object")) {
    return [{ keys, value: value.join(", ") || "none" }];
  }
  const first = Array.isArray(value) ? 1 : 0;
  return Object.entries(value).flatMap(([key, v]) => leaves(v, [first ? String(Number(key) + first) : key, ...keys]));
}

/// What a value is called among its section's: "build voxelise".
export const leafName = (keys) => keys.toReversed().map(words).join(" ");

function section(title, value) {
  const rows = leaves(value).map(({ keys, value: v }) => [leafName(keys), quantity(v, [...keys, title])]);
  return rows.length > 0 && h("section", h("h3", words(title)), table(["", ""], rows, true));
}

/// The whole report as one element: a section for each of its parts, what stands alone first.
export function reportView({ artefacts, race, ...report }) {
  const parts = Object.entries(report);
  const alone = parts.filter(([, v]) => v === null || typeof v !== "object");
  return h("div.report", section("job", Object.fromEntries(alone)),
    parts.filter((part) => !alone.includes(part)).map(([title, value]) => section(title, value)));
}
