// A job killed at any moment goes on to the bits of an uninterrupted one.
// LACUNA_KILLS: how many kills (3 in a quick run, 20 in a long one).

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";

import { job, run, start, temporaryFolder } from "./command.mjs";

const kills = Number(process.env.LACUNA_KILLS ?? 3);
const spec = {
  scene: "ajar.glb",
  resolution: [160, 120],
  budget: { iterations: 60 },
  layers: ["variance", "halves"],
  checkpoint_seconds: 0.05,
};

async function sameBits(folder, a, b) {
  const { out, code } = await run(folder, "compare", join(a, "image.exr"), join(b, "image.exr"));
  assert.equal(code, 0);
  assert.match(out, /^mse +0$/m);
  const rays = (name) => JSON.parse(readFileSync(join(folder, name, "report.json"), "utf8")).counts;
  assert.deepEqual(rays(a), rays(b));
}

test(`killed ${kills} times and resumed: the same bits`, async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "whole.json", spec);
  job(folder, "killed.json", spec);
  const begun = Date.now();
  assert.equal((await run(folder, "render", "whole.json", "-q")).code, 0);
  const length = Date.now() - begun;
  let killed = 0;
  for (let i = 0; i < kills; ++i) {
    const { child, ended } = start(folder, "render", "killed.json", "-q");
    // Any moment: from the start of the process to the writing of results.
    await Promise.race([pause((length * ((i * 7919) % 101)) / 101), ended]);
    child.kill("SIGKILL");
    if ((await ended).signal === "SIGKILL") ++killed;
  }
  assert.ok(killed > 0, "no kill came in time");
  const last = await run(folder, "render", "killed.json", "-q");
  assert.equal(last.code, 0, last.err);
  await sameBits(folder, "whole.job", "killed.job");
});

test("stopped by SIGTERM: exit 75, state interrupted, then the same bits", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "whole.json", spec);
  job(folder, "stopped.json", spec);
  assert.equal((await run(folder, "render", "whole.json", "-q", "--threads", "1")).code, 0);
  const { child, ended } = start(folder, "render", "stopped.json");
  const progress = join(folder, "stopped.job", "checkpoint.bin");
  while (!existsSync(progress) && child.exitCode === null) await pause(5);
  child.kill("SIGTERM");
  const stopped = await ended;
  assert.equal(stopped.code, 75, stopped.err);
  assert.equal(JSON.parse(readFileSync(join(folder, "stopped.job/state.json"), "utf8")).state, "interrupted");
  assert.equal((await run(folder, "render", "stopped.json", "-q")).code, 0);
  await sameBits(folder, "whole.job", "stopped.job");
});

test("a disk that is full: failed with the reason, nothing stored is lost", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, budget: { iterations: 4 } });
  // A limit on file sizes stands for a full disk: the checkpoint and the picture do not fit.
  const { spawn } = await import("node:child_process");
  const { root } = await import("./command.mjs");
  const child = spawn("bash", ["-c", `ulimit -f 64; exec "${join(process.env.LACUNA_BIN ?? join(root, "build/release/bin"), "lacuna")}" render a.json`], {
    cwd: folder,
    env: { ...process.env, LACUNA_SCENES: join(root, "jobs/scenes"), LACUNA_DATA: join(folder, "data") },
  });
  let err = "";
  child.stderr.on("data", (bytes) => (err += bytes));
  const code = await new Promise((done) => child.on("close", done));
  assert.equal(code, 1, err);
  assert.match(err, /(image\.exr|checkpoint\.bin).*(large|space)/i);
  const state = JSON.parse(readFileSync(join(folder, "a.job/state.json"), "utf8"));
  assert.equal(state.state, "failed");
  assert.ok(!existsSync(join(folder, "a.job/image.exr")));
  // With room again the same command does it.
  assert.equal((await run(folder, "render", "a.json", "-q")).code, 0);
});
