// A sweep's table of answers, from answers that are made for it.
import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./module_page.mjs";

/// Cells that differ in one setting; `gains` are their gains at 10 s.
function answersOf(values, gains = []) {
  const cells = values.map((value, i) => ({
    cell: i + 1, text: `name ${value}`, settings: { "/name": value }, baseline: 1, done: 3, runs: [], curve: [], to: [],
    at: [{ error: { value: 1 }, gain: gains[i], supported: true, reached: 3 }],
    preparation: { cold: null, warm: null }, pays: { cold: null, warm: null },
  }));
  return {
    cells, settings: ["/name"], clock: "seconds", metric: "rmse", warnings: [], seeds: 3, states: { done: 3 * cells.length },
    pictures: [{ text: "", cells: cells.map((c) => c.cell), seconds: [10], errors: [],
      front: { render: [], warm: [], cold: [] } }],
  };
}

/// What `read`, a function of the table's element, gives for the answers.
const shown = (answers, query, read) => page.evaluate(async ([given, search, text]) => {
  const { answersView } = await import("/answers.js");
  const view = answersView(new URLSearchParams(search), () => null);
  view.show(given);
  return [...view.element.querySelectorAll(text.rows)].map((element) => element[text.what]);
}, [answers, query, read]);

test("a gain is better or worse only where its interval does not contain 1", async () => {
  const gains = [{ value: 2, low: 1.5, high: 3 }, { value: 0.5, low: 0.4, high: 0.7 }, { value: 0.9, low: 0.7, high: 1.1 },
    { value: 1.2, low: 0.9, high: 1.6 }, { value: 3, at_least: true }, { value: 0.5, at_least: true }];
  const classes = await shown(answersOf(["a", "b", "c", "d", "e", "f"], gains), "",
    { rows: "tbody tr td:last-child > span", what: "className" });
  assert.deepEqual(classes, ["better", "worse", "", "", "better", ""]);
});

test("settings are sorted by the numbers in them, and the other way round", async () => {
  const names = (query) => shown(answersOf(["a10", "a9", "b1", "a2"]), query,
    { rows: "tbody tr td:nth-child(3)", what: "textContent" });
  assert.deepEqual(await names("sort=/name"), ["a2", "a9", "a10", "b1"]);
  assert.deepEqual(await names("sort=-/name"), ["b1", "a10", "a9", "a2"]);
  assert.deepEqual(await names(""), ["a10", "a9", "b1", "a2"]);
});
