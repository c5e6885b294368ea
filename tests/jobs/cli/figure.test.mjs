// `lacuna figure`: from a sweep to a figure in three commands.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { run, temporaryFolder } from "./command.mjs";

const sweep = {
  seeds: 2, baseline: { "/integrator/type": "path" },
  job: { scene: "ajar.glb", camera: "room", resolution: [48, 32], budget: { iterations: 4 }, integrator: { max_depth: 4 },
    reference: "auto", reference_iterations: 8 },
  axes: { "/integrator/type": ["path", "bdpt"] },
};

test("figure: suggested, drawn in every format, with the numbers of the report", async (t) => {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, "a.json"), JSON.stringify(sweep));
  assert.equal((await run(folder, "sweep", "a.json")).code, 0);
  const suggested = await run(folder, "figure", "--suggest", "a.sweep", "-o", "f.json");
  assert.equal(suggested.code, 0, suggested.err);
  const spec = JSON.parse(readFileSync(join(folder, "f.json"), "utf8"));
  assert.equal(spec.sweep, "a.sweep");
  assert.deepEqual(spec.methods.map((m) => m.name), ["path", "bdpt"]);
  assert.equal(spec.scenes[0].crops.length, 2);
  assert.equal((await run(folder, "figure", "--suggest", "a.sweep")).out, readFileSync(join(folder, "f.json"), "utf8"));
  const names = ["f.pdf", "f.svg", "f.png", "f.tex", "f.csv", "f.md"];
  const drawn = await run(folder, "figure", "f.json", ...names.flatMap((name) => ["-o", name]));
  assert.equal(drawn.code, 0, drawn.err);
  for (const name of names) assert.match(drawn.out, new RegExp(`^${name} \\(\\d+\\.\\d MB\\)$`, "m"));
  const report = JSON.parse((await run(folder, "report", "a.sweep", "--json")).out);
  const [header, ...rows] = readFileSync(join(folder, "f.csv"), "utf8").trimEnd().split("\n");
  assert.equal(header, "scene,method,quantity,at,value,low,high,runs,at_most,at_least,supported");
  const fields = (...values) => values.map((v) => (v === undefined || v === null ? "" : String(v)));
  for (const [i, method] of ["path", "bdpt"].entries()) {
    const lines = rows.map((row) => row.split(",")).filter((f) => f[1] === method);
    const at = report.cells[i].at.at(-1);
    const to = report.cells[i].to.at(-1);
    for (const [quantity, where, value] of [["relmse", at?.seconds, at?.error], ["seconds_to_error", to?.error, to?.time]]) {
      const line = lines.find((f) => f[2] === quantity);
      assert.equal(line === undefined, where === undefined);
      if (line === undefined) continue;
      assert.equal(Number(line[3]), where);
      const numbers = line.slice(4, 8).map((text) => (text === "" ? "" : String(Number(text))));
      assert.deepEqual(numbers, fields(value?.value, value?.low, value?.high, value?.n));
    }
  }
});

test("figure: wrong files and options name their place", async (t) => {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, "f.json"), JSON.stringify({ sweep: "none.sweep", scenes: [{ name: "a" }], methods: [{ name: "b" }] }));
  const missing = await run(folder, "figure", "f.json", "-o", "f.pdf");
  assert.equal(missing.code, 2);
  assert.match(missing.err, /\/sweep: found "none\.sweep"/);
  const ending = await run(folder, "figure", "f.json", "-o", "f.gif");
  assert.equal(ending.code, 2);
  assert.match(ending.err, /"f\.gif" ends in none of \.pdf, \.svg/);
  for (const args of [["f.json"], [], ["f.json", "--suggest", "."]]) {
    assert.equal((await run(folder, "figure", ...args)).code, 2);
  }
  const schema = JSON.parse((await run(folder, "schema", "--figure")).out);
  assert.deepEqual(schema.required, ["sweep", "scenes", "methods"]);
});
