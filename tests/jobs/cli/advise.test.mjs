// lacuna advise: the race alone, told as a table or as JSON.

import assert from "node:assert/strict";
import { test } from "node:test";

import { job, run, temporaryFolder } from "./command.mjs";

const small = ["--resolution", "48", "32", "--seconds", "0.5", "--max_depth", "4"];

test("a scene: every candidate with its fate, and the advice", async (t) => {
  const folder = temporaryFolder(t);
  const told = await run(folder, "advise", "cornell.glb", ...small);
  assert.equal(told.code, 0, told.err);
  for (const name of ["path, reuse 16", "metropolis, path_space", "bdpt", "bdpt, skeleton", "many_lights, probabilistic"]) {
    assert.match(told.out, new RegExp(`^${name} {2,}`, "m"));
  }
  assert.match(told.out, /bdpt, skeleton .*a budget below 10 s is not worth an analysis of the space/);
  assert.match(told.out, /<- chosen/);
  assert.match(told.out, /^0\.5 s: .*The race took [0-9.]+ s(, of pixels [0-9]+ times as wide)?\.$/m);
});

test("a job: its own candidates, and the JSON of a report", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { scene: "ajar.glb", resolution: [48, 32],
    integrator: { type: "auto", max_depth: 4, candidates: [{ type: "path" }, { type: "bdpt", connections: { type: "skeleton" } }] } });
  const told = await run(folder, "advise", "a.json", "--seconds", "0.5", "--json");
  assert.equal(told.code, 0, told.err);
  const race = JSON.parse(told.out);
  assert.deepEqual(race.candidates.map((c) => c.name), ["path", "bdpt, skeleton"]);
  assert.ok(race.candidates.some((c) => c.in_use));
  assert.ok(race.spent > 0 && race.rounds.length >= 2);
});

test("a job of a fixed method: its lengths of paths", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { scene: "ajar.glb", resolution: [32, 32], integrator: { type: "path", max_depth: 1 } });
  const told = await run(folder, "advise", "a.json", "--seconds", "0.2", "--json");
  assert.equal(told.code, 0, told.err);
  assert.equal(JSON.parse(told.out).candidates.length, 5);
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
