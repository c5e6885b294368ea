// A curve's rows as a table, for reading and for those who cannot see the plot.
import { table } from "./dom.js";
import { number, words } from "./format.js";

/// All columns that have a value.
export function curveTable(rows) {
  if (rows.length === 0) return "";
  const keys = Object.keys(rows[0]).filter((key) => rows.some((row) => row[key] !== null));
  return table(keys.map(words), rows.map((row) => keys.map((key) => number(row[key], 4))), true);
}
