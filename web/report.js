// report.json as readable tables, whatever keys it has: nested objects become sections, objects of
// like objects become one table, and units come from the keys.
import { h, table } from "./dom.js";
import { quantity, words } from "./format.js";

const isObject = (v) => v !== null && typeof v === "object" && !Array.isArray(v);
const isLeaf = (v) => !isObject(v) && !(Array.isArray(v) && v.some(isObject));
const numeric = (v) => typeof v === "number";

function leafText(value, keys) {
  if (!Array.isArray(value)) return quantity(value, keys);
  return value.length === 0 ? "none" : value.map((v) => quantity(v, keys)).join(", ");
}

/// "load: {seconds, calls}, build: {seconds}": two or more records of leaves with few columns.
function isMatrix(object) {
  const records = Object.values(object);
  if (records.length < 2 || !records.every((r) => isObject(r) && Object.keys(r).length > 0)) return false;
  const columns = new Set(records.flatMap((r) => Object.keys(r)));
  return columns.size <= 8 && records.every((r) => Object.values(r).every(isLeaf));
}

function matrix(object, keys) {
  const columns = [...new Set(Object.values(object).flatMap((r) => Object.keys(r)))];
  const heads = columns.map((key) => ({
    title: words(key),
    number: Object.values(object).every((r) => r[key] === undefined || numeric(r[key])),
  }));
  const rows = Object.entries(object).map(([name, record]) => [words(name), ...columns.map(
    (key) => (record[key] === undefined ? "" : leafText(record[key], [key, name, ...keys])))]);
  return table(["", ...heads], rows, "values");
}

/// A list of records: rows of one table, numbered from 1.
function list(records, keys) {
  return section(Object.fromEntries(records.map((r, i) => [String(i + 1), r])), keys);
}

function section(object, keys) {
  if (isMatrix(object)) return [matrix(object, keys)];
  const leaves = Object.entries(object).filter(([, v]) => isLeaf(v));
  const nested = Object.entries(object).filter(([, v]) => !isLeaf(v));
  const rows = leaves.map(([key, value]) => h("tr", {},
    h("th", { scope: "row" }, words(key)),
    h("td", { className: numeric(value) ? "number" : "" }, leafText(value, [key, ...keys]))));
  return [
    rows.length > 0 && h("table", { className: "values" }, h("tbody", {}, rows)),
    nested.map(([key, value]) => h("section", {},
      h("h3", {}, words(key)),
      Array.isArray(value) ? list(value, [key, ...keys]) : section(value, [key, ...keys]))),
  ];
}

/// The whole report as one element.
export const reportView = (report) => h("div", { className: "report" }, section(report, []));
