// lacuna advise: the choice of a method alone, as a table or as JSON, and a job that goes on from it.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { job, run, temporaryFolder } from "./command.mjs";

const small = ["--resolution", "48", "32", "--seconds", "0.5", "--max_depth", "4"];

test("a scene: every candidate, and the one that was chosen", async (t) => {
  const folder = temporaryFolder(t);
  const told = await run(folder, "advise", "cornell.glb", ...small);
  assert.equal(told.code, 0, told.err);
  for (const name of ["path, reuse 16", "path, learned_skeleton, reuse 64", "metropolis, path_space", "bdpt, skeleton", "many_lights, probabilistic"]) {
    assert.match(told.out, new RegExp(`^${name} {2,}`, "m"));
  }
  assert.equal(told.out.match(/<- chosen/g).length, 1);
});

test("a job: its own candidates, as JSON, in a folder that goes on", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { scene: "ajar.glb", resolution: [48, 32],
    integrator: { type: "auto", max_depth: 4, candidates: [{ type: "path" }, { type: "bdpt", connections: { type: "skeleton" } }] } });
  const told = await run(folder, "advise", "a.json", "--seconds", "0.5", "--json", "--out", "kept");
  assert.equal(told.code, 0, told.err);
  const choice = JSON.parse(told.out);
  assert.deepEqual(choice.candidates.map((c) => c.name), ["path", "bdpt, skeleton"]);
  assert.ok(choice.candidates[choice.chosen].turns.length > 0);
  assert.equal((await run(folder, "render", "kept")).code, 0);
  assert.deepEqual(JSON.parse(readFileSync(join(folder, "kept", "report.json"))).choice, choice);
  assert.ok(existsSync(join(folder, "kept", "image.exr")));
});

test("a job of a fixed method: its lengths of paths", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { scene: "ajar.glb", resolution: [32, 32], integrator: { type: "path", max_depth: 1 } });
  const told = await run(folder, "advise", "a.json", "--seconds", "0.2", "--json");
  assert.equal(told.code, 0, told.err);
  const { candidates } = JSON.parse(told.out);
  assert.equal(candidates.length, 5);
  for (const { integrator } of candidates) assert.equal(integrator.max_depth, 1);
});

test("what is not there is refused by name", async (t) => {
  const folder = temporaryFolder(t);
  const scene = await run(folder, "advise", "nowhere.glb");
  assert.notEqual(scene.code, 0);
  assert.match(scene.err, /nowhere\.glb/);
  const camera = await run(folder, "advise", "cornell.glb", "--camera", "behind");
  assert.notEqual(camera.code, 0);
  assert.match(camera.err, /behind/);
  assert.equal((await run(folder, "advise", "cornell.glb", "--seconds", "0")).code, 2);
});
