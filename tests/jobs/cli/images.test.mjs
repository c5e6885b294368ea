import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";

import { job, program, root, run, startWith, temporaryFolder } from "./command.mjs";

/// Runs `lacuna ARGS` and gives whether that process itself loaded OpenImageIO, as its linker tells.
async function loadsImages(folder, ...args) {
  const { child, ended } = startWith(["env", "LD_DEBUG=libs", `LD_DEBUG_OUTPUT=${join(folder, "linker")}`], folder, ...args);
  const { code, err } = await ended;
  assert.equal(code, 0, `${args}: ${err}`);
  const told = readFileSync(join(folder, `linker.${child.pid}`), "utf8");
  assert.match(told, /find library=libembree3/);
  return told.includes("libOpenImageIO");
}

test("what needs no image never loads the module of images", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  const sweep = { job: { scene: "cornell.glb", resolution: [24, 16], budget: { iterations: 1 } }, axes: { "/seed": [1, 2] } };
  writeFileSync(join(folder, "s.json"), JSON.stringify(sweep));
  for (const args of [["--version"], ["--help"], ["list"], ["schema"], ["schema", "--sweep"], ["cache", "list"],
    ["check", "a.json"], ["check", "--scene", join(root, "jobs/scenes/cornell.glb")],
    ["sweep", "s.json", "--quiet"], ["sweep", "s.json", "--list"], ["sweep", "s.json", "--missing"]]) {
    assert.equal(await loadsImages(folder, ...args), false, args.join(" "));
  }
  // Runs that fail leave nothing to look at.
  writeFileSync(join(folder, "f.json"), JSON.stringify({ ...sweep, job: { ...sweep.job, scene: "nowhere.glb" } }));
  assert.equal((await run(folder, "sweep", "f.json", "--quiet")).code, 1);
  assert.equal(await loadsImages(folder, "report", "f.sweep"), false);
});

test("a render loads it while it prepares; so does a check of textures", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  assert.equal(await loadsImages(folder, "render", "a.json"), true);
  const { image_module: told, seconds } = JSON.parse(readFileSync(join(folder, "a.job/report.json"), "utf8"));
  assert.ok(told.begun >= 0 && told.begun < 5 && told.seconds > 0 && told.cpu_seconds > 0, JSON.stringify(told));
  assert.ok(seconds.images >= 0 && seconds.images < 60, JSON.stringify(seconds));
  assert.equal(await loadsImages(folder, "render", "a.json"), false, "a job that is done");
  assert.equal(await loadsImages(folder, "check", "--scene", join(root, "jobs/scenes/ajar.glb")), true);
});

test("the service does not even know the module", () => {
  const server = readFileSync(join(dirname(program), "lacuna-server"));
  for (const name of ["lacuna-images", "libOpenImageIO"]) assert.equal(server.includes(name), false, name);
  assert.ok(readFileSync(program).includes("lacuna-images"));
});

test("the module lies beside the program; without it a job waits before it is rendered", async (t) => {
  const folder = temporaryFolder(t);
  const bin = join(folder, "elsewhere");
  mkdirSync(bin);
  copyFileSync(program, join(bin, "lacuna"));
  job(folder, "a.json", {});
  const moved = (...args) => spawnSync(join(bin, "lacuna"), args, { cwd: folder, encoding: "utf8",
    env: { ...process.env, LACUNA_DATA: join(folder, "data"), LACUNA_SCENES: join(root, "jobs/scenes") } });
  const missing = moved("render", "a.json");
  assert.equal(missing.status, 75, missing.stderr);
  assert.match(missing.stderr, /elsewhere\/lacuna-images\.so: images can be neither read nor written: .*No such file/);
  const state = JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8"));
  assert.equal(state.state, "interrupted");
  assert.match(state.error, /lacuna-images\.so/);
  assert.equal(existsSync(join(folder, "a.job/checkpoint.bin")), false);
  assert.equal(moved("check", "a.json").status, 0);
  copyFileSync(join(dirname(program), "lacuna-images.so"), join(bin, "lacuna-images.so"));
  assert.equal(moved("render", "a.json").status, 0);
});
