// `lacuna figure`: from a sweep to a figure in three commands.

import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { program, run, temporaryFolder } from "./command.mjs";

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

test("figure: of jobs, by their folders and by their ids in the data folder", async (t) => {
  const folder = temporaryFolder(t);
  const id = "20260131-235959-k3x9qa";
  mkdirSync(join(folder, "data/jobs"), { recursive: true });
  for (const [name, place, integrator] of [["a", "a.job", "path"], ["b", `data/jobs/${id}`, "bdpt"]]) {
    writeFileSync(join(folder, `${name}.json`), JSON.stringify({ ...sweep.job, integrator: { type: integrator, max_depth: 4 } }));
    const done = await run(folder, "render", `${name}.json`, "--out", place);
    assert.equal(done.code, 0, done.err);
  }
  const spec = { show: ["pictures", "table"], scenes: [{ name: "Ajar" }], methods: [
    { name: "Path", jobs: ["a.job"] }, { name: "BDPT", jobs: [id] }] };
  writeFileSync(join(folder, "f.json"), JSON.stringify(spec));
  const drawn = await run(folder, "figure", "f.json", "-o", "f.svg", "-o", "f.csv");
  assert.equal(drawn.code, 0, drawn.err);
  const refused = await run(folder, "figure", "f.json", "--ids", "-o", "f.svg");
  assert.equal(refused.code, 2);
  assert.match(refused.err, /\/methods\/0\/jobs\/0: found "a\.job": there is no such folder; allowed: the id of a job$/m);
  const methods = readFileSync(join(folder, "f.csv"), "utf8").trim().split("\n").slice(1).map((line) => line.split(",")[1]);
  assert.deepEqual([...new Set(methods)], ["Path", "BDPT"]);
});

test("figure: another program's pictures are a column", async (t) => {
  const folder = temporaryFolder(t);
  // The other program is `lacuna render` itself, which the script gives the seed and the name that it is asked for.
  writeFileSync(join(folder, "other.sh"), `#!/bin/sh
printf '{"scene": "ajar.glb", "camera": "room", "resolution": [%s, %s], "seed": %s, "budget": {"iterations": 16},
  "integrator": {"type": "path", "max_depth": 4}}' "$1" "$2" "$3" > "$4.json"
"${program}" render "$4.json" --out "$4.job" --quiet && cp "$4.job/image.exr" "$4"
`, { mode: 0o755 });
  const foreign = { type: "foreign", name: "Another", max_depth: 4, format: "exr", seconds: [1],
    command: [join(folder, "other.sh"), "{width}", "{height}", "{seed}", "{out}"] };
  const { axes, baseline, ...rest } = sweep;
  writeFileSync(join(folder, "a.json"), JSON.stringify({ ...rest, axes: { "/integrator": [{ type: "path", max_depth: 4 }, foreign] } }));
  const swept = await run(folder, "sweep", "a.json");
  assert.equal(swept.code, 0, swept.err);
  assert.equal((await run(folder, "figure", "--suggest", "a.sweep", "-o", "f.json")).code, 0);
  const spec = JSON.parse(readFileSync(join(folder, "f.json"), "utf8"));
  assert.equal(spec.methods[1].name, "Another");
  const drawn = await run(folder, "figure", "f.json", "-o", "f.svg", "-o", "f.csv", "-o", "f.tex");
  assert.equal(drawn.code, 0, drawn.err);
  const rows = readFileSync(join(folder, "f.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  const found = rows.filter((f) => f[1] === "Another" && f[2] === "relmse");
  const report = JSON.parse((await run(folder, "report", "a.sweep", "--json")).out);
  const at = report.cells[1].at.at(-1);
  assert.equal(found.length, at ? 1 : 0);
  if (at?.error) assert.equal(Number(found[0][4]), at.error.value);
  // Two pictures a scene in the crops, one in the error maps, for each of two methods.
  for (const piece of ["1-2-crop1", "1-2-crop2", "1-2-error"]) assert.ok(existsSync(join(folder, `f-pieces/${piece}.png`)), piece);
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
  assert.deepEqual(schema.required, ["scenes", "methods"]);
});
