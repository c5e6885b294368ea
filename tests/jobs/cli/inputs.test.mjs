// What a result was made from is part of it: the same command after the files have changed.

import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, readFileSync, renameSync, utimesSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { job, root, run, startWith, temporaryFolder } from "./command.mjs";

const small = { scene: "own.glb", resolution: [8, 8], budget: { iterations: 2 } };
const bytes = (...name) => readFileSync(join(...name));
const read = (...name) => JSON.parse(bytes(...name));

/// The scene of these jobs; changed: its walls reflect half, in a file of the same size.
function putScene(folder, changed = false) {
  const scene = bytes(root, "jobs/scenes/furnace.glb");
  const length = scene.readUInt32LE(12);
  const document = JSON.parse(scene.subarray(20, 20 + length));
  if (changed) {
    for (const material of document.materials) {
      const color = material.pbrMetallicRoughness.baseColorFactor;
      material.pbrMetallicRoughness.baseColorFactor = [...color.slice(0, 3).map((c) => c / 2), 1];
    }
  }
  const text = Buffer.alloc(4096, " ");
  text.write(JSON.stringify(document));
  const head = Buffer.from(scene.subarray(0, 20));
  head.writeUInt32LE(text.length, 12);
  head.writeUInt32LE(scene.length - length + text.length, 8);
  writeFileSync(join(folder, "own.glb"), Buffer.concat([head, text, scene.subarray(20 + length)]));
}

test("render, extend, compare: changed inputs are refused by name, --again renders anew", async (t) => {
  const folder = temporaryFolder(t);
  putScene(folder);
  job(folder, "a.json", small);
  assert.equal((await run(folder, "render", "a.json", "-q")).code, 0);
  utimesSync(join(folder, "own.glb"), 1, 1);
  const same = await run(folder, "render", "a.json");
  assert.deepEqual([same.code, /already done/.test(same.err)], [0, true], same.err);

  const picture = bytes(folder, "a.job/image.exr"), was = read(folder, "a.job/job.json");
  putScene(folder, true);
  for (const words of [["render", "a.json"], ["render", "a.job"], ["extend", "a.job", "--iterations", "8"]]) {
    const refused = await run(folder, ...words);
    assert.equal(refused.code, 2, refused.err);
    assert.match(refused.err, /scene "own\.glb" has changed contents of the same size; .*--again/);
  }
  assert.ok(bytes(folder, "a.job/image.exr").equals(picture));
  assert.deepEqual(read(folder, "a.job/job.json"), was);
  assert.equal(read(folder, "a.job/outcome.json").state, "done");

  assert.equal((await run(folder, "render", "a.json", "--out", "b.job", "-q")).code, 0);
  const compared = await run(folder, "compare", "a.job", "b.job/image.exr");
  assert.equal(compared.code, 0);
  assert.match(compared.err, /^warning: .*scene "own\.glb" has changed contents/);
  assert.doesNotMatch(compared.out, /^mse +0$/m);

  const again = await run(folder, "render", "a.json", "--again");
  assert.equal(again.code, 0, again.err);
  const equal = await run(folder, "compare", "a.job", "b.job");
  assert.match(equal.out, /^mse +0$/m);
  assert.equal(equal.err, "");
});

test("sweep: runs of changed inputs are rendered anew, and told", async (t) => {
  const folder = temporaryFolder(t);
  putScene(folder);
  writeFileSync(join(folder, "s.json"), JSON.stringify({ job: small, axes: { "/seed": [1, 2] } }));
  assert.equal((await run(folder, "sweep", "s.json", "-q", "--index", "1")).code, 0);
  const inputs = join("s.sweep/runs/0001-1/inputs.json");
  const old = read(folder, inputs);
  putScene(folder, true);
  assert.equal((await run(folder, "sweep", "s.json", "--missing")).out, "1-2\n");
  const resumed = await run(folder, "sweep", "s.json");
  assert.equal(resumed.code, 0, resumed.err);
  assert.match(resumed.err, /the input files of 0001-1 have changed \(scene "own\.glb" has changed contents.*rendered again/);
  assert.notDeepEqual(read(folder, inputs), old);
  assert.deepEqual(read(folder, inputs), read(folder, "s.sweep/runs/0002-1/inputs.json"));
  assert.equal((await run(folder, "sweep", "s.json", "--missing")).out, "\n");
});

test("a folder of scenes that is away for a moment: exit 75, and the same command goes on", async (t) => {
  const folder = temporaryFolder(t);
  const scenes = join(folder, "scenes");
  const runThere = (...words) => startWith(["env", `LACUNA_SCENES=${scenes}`], folder, ...words).ended;
  mkdirSync(scenes);
  job(folder, "a.json", { ...small, scene: "furnace.glb" });
  for (const words of [["render", "a.json"], ["check", "a.json"]]) {
    const away = await runThere(...words);
    assert.equal(away.code, 75, away.err);
    assert.match(away.err, /cannot read .*furnace\.glb: .*scenes is missing or empty/);
  }
  assert.equal(read(folder, "a.job/outcome.json").state, "interrupted");
  renameSync(scenes, join(folder, "away"));
  assert.equal((await runThere("render", "a.json")).code, 75);
  renameSync(join(folder, "away"), scenes);
  copyFileSync(join(root, "jobs/scenes/furnace.glb"), join(scenes, "furnace.glb"));
  const done = await runThere("render", "a.json");
  assert.equal(done.code, 0, done.err);
  assert.ok(existsSync(join(folder, "a.job/image.exr")));
});
