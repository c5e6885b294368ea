// A job killed at any moment goes on to the bits of an uninterrupted one.
// LACUNA_KILLS: how many kills (3 in a quick run, 20 in a long one).

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";

import { job, root, run, start, startWith, temporaryFolder } from "./command.mjs";

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
  assert.equal(JSON.parse(readFileSync(join(folder, "stopped.job/outcome.json"), "utf8")).state, "interrupted");
  assert.equal((await run(folder, "render", "stopped.json", "-q")).code, 0);
  await sameBits(folder, "whole.job", "stopped.job");
});

/// The same command, run by a shell after `setting`.
function runAfter(setting, folder, ...args) {
  return startWith(["bash", "-c", `${setting}; exec "$0" "$@"`], folder, ...args).ended;
}

test("a grace that is no number of seconds is refused before anything is rendered", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  const refused = await runAfter("export LACUNA_GRACE=soon", folder, "render", "a.json");
  assert.equal(refused.code, 2);
  assert.match(refused.err, /LACUNA_GRACE: soon; allowed: seconds, at least 0/);
});

const stateOf = (folder) => JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8"));
const temporaries = (folder) => readdirSync(join(folder, "a.job")).filter((name) => name.endsWith(".tmp"));

/// Renders a job with checkpoints until it is stopped; gives the checkpoint's bytes.
async function begin(folder, content = {}) {
  job(folder, "a.json", { ...spec, budget: { iterations: 100000 }, ...content });
  const { child, ended } = start(folder, "render", "a.json", "-q");
  const checkpoint = join(folder, "a.job/checkpoint.bin");
  while (!existsSync(checkpoint) && child.exitCode === null) await pause(5);
  child.kill("SIGTERM");
  assert.equal((await ended).code, 75);
  return readFileSync(checkpoint);
}

test("a file that does not fit: interrupted with the reason, the old checkpoint whole", async (t) => {
  const folder = temporaryFolder(t);
  const checkpoint = await begin(folder);
  const full = await runAfter("ulimit -f 16", folder, "render", "a.json");
  assert.equal(full.code, 75, full.err);
  assert.match(full.err, /error: cannot write .*(checkpoint\.bin|image\.png).*File too large.*the same command continues/);
  assert.match(readFileSync(join(folder, "a.job/log.txt"), "utf8"), /File too large/);
  assert.equal(stateOf(folder).state, "interrupted");
  assert.match(stateOf(folder).error, /cannot write/);
  assert.deepEqual(readFileSync(join(folder, "a.job/checkpoint.bin")), checkpoint);
  assert.deepEqual(temporaries(folder), []);
});

test("no room for the results: interrupted, and done with room again", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, budget: { iterations: 4 }, checkpoint_seconds: 100 });
  const full = await runAfter("ulimit -f 16", folder, "render", "a.json");
  assert.equal(full.code, 75, full.err);
  assert.match(full.err, /warning: cannot write .*checkpoint\.bin/);
  assert.match(full.err, /error: cannot write .*(layers\.half|image\.exr)/);
  assert.equal(stateOf(folder).state, "interrupted");
  assert.ok(!existsSync(join(folder, "a.job/image.exr")));
  assert.deepEqual(temporaries(folder), []);
  assert.equal((await run(folder, "render", "a.json", "-q")).code, 0);
  assert.equal(stateOf(folder).error, "");
});

test("a disk that fills up while a job is rendered, and a folder that turns read-only", async (t) => {
  let unmount = () => {};
  t.after(() => unmount());  // before the folder is removed
  const folder = temporaryFolder(t);
  const disk = join(folder, "disk");
  mkdirSync(disk);
  const mounted = process.getuid() === 0
    && spawnSync("mount", ["-t", "tmpfs", "-o", "size=12m", "tmpfs", disk]).status === 0;
  if (!mounted) return t.skip("a small disk can be mounted by root only");
  unmount = () => spawnSync("umount", [disk]);
  const checkpoint = await begin(disk);
  const out = join(disk, "a.job");
  writeFileSync(join(disk, "ballast"), "");
  spawnSync("dd", ["if=/dev/zero", `of=${join(disk, "ballast")}`, "bs=4096"]);  // until it is full
  const full = await run(disk, "render", "a.json");
  assert.equal(full.code, 75, full.err);
  assert.match(full.err, /No space left on device/);
  assert.deepEqual(readFileSync(join(out, "checkpoint.bin")), checkpoint);
  assert.deepEqual(temporaries(disk), []);

  rmSync(join(disk, "ballast"));
  assert.equal(spawnSync("mount", ["-o", "remount,ro", disk]).status, 0);
  const sealed = await run(disk, "render", "a.json");
  assert.equal(sealed.code, 75, sealed.err);
  assert.match(sealed.err, /Read-only file system/);
  assert.equal(spawnSync("mount", ["-o", "remount,rw", disk]).status, 0);
  assert.deepEqual(readFileSync(join(out, "checkpoint.bin")), checkpoint);

  const { child, ended } = start(disk, "render", "a.json");
  while (!/continuing from iteration/.test(readFileSync(join(out, "log.txt"), "utf8").split("Read-only").pop())
    && child.exitCode === null) await pause(5);
  child.kill("SIGTERM");
  assert.equal((await ended).code, 75);
  assert.equal(stateOf(disk).error, "", "stopped on request");
});

test("not enough memory: exit 71, resumable, and it says what to do", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { resolution: [4096, 4096], budget: { iterations: 1 } });
  const short = await runAfter("ulimit -d 524288", folder, "render", "a.json", "-t", "2");
  assert.equal(short.code, 71, short.err);
  assert.match(short.err, /error: out of memory.*; raise the limit of 512\.0 MiB \(ulimit -d\), .*resolution/);
  assert.equal(stateOf(folder).state, "interrupted");
  assert.match(stateOf(folder).error, /^out of memory/);
});

// Each method asks for more memory than a machine has, all at once, when it knows how much.
const hungry = {
  "importance_cache: the distributions of .* light paths": {
    resolution: [512, 512],
    integrator: { type: "bdpt", connections: { type: "importance_cache", record_density: 0.05, light_paths: 20000 } },
  },
  "many_lights: the visibility of .* cache points": {
    resolution: [1024, 1024],
    integrator: { type: "many_lights", light_paths: 1000000, visibility: { type: "probabilistic", cache_points: 1000000 } },
  },
  "view_maps: maps of .* views": {
    integrator: { type: "many_lights", light_paths: 500000, visibility: { type: "view_maps", map_size: 256, levels: 8 } },
  },
};
for (const [part, content] of Object.entries(hungry)) {
  for (const limit of ["-d", "-v"]) {
    test(`more than ulimit ${limit} allows, ${part.split(":")[0]}: exit 71, resumable, with the bytes`, async (t) => {
      const folder = temporaryFolder(t);
      job(folder, "a.json", { ...content, budget: { iterations: 1 } });
      const { code, err } = await runAfter(`ulimit ${limit} 2000000`, folder, "render", "a.json", "-q", "-t", "2");
      assert.equal(code, 71, err);
      assert.match(err, new RegExp(`error: out of memory: ${part}.*: [0-9.]+ MiB, of [0-9.]+ MiB that are available; .*the same command continues`));
      assert.equal(stateOf(folder).state, "interrupted");
    });
  }
}

// Some libraries of the image module end or hang their process where address space is short; the
// limits are those where they did, and one that is enough.
test("the image module does not fit the limit of address space: exit 71, and it says so", async (t) => {
  const folder = temporaryFolder(t);
  const picture = join(root, "tests/fuzz/corpus/float_image/none.exr");
  await Promise.all([220, 280, 290, 300, 390, 400, 410, 2000].map(async (mebibytes) => {
    const { code, signal, err } = await runAfter(`ulimit -v ${mebibytes * 1024}`, folder, "compare", picture, picture);
    assert.equal(code, mebibytes < 2000 ? 71 : 0, `${mebibytes} MiB: ${signal} ${err}`);
    if (code === 71) assert.match(err, /^lacuna: out of memory: .*images.so: .* exceed the memory limit \(ulimit -v/);
  }));
});

test("wherever memory runs out, it ends as itself and goes on with more", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { scene: "ajar.glb", resolution: [192, 108], layers: ["albedo", "variance"] });
  let short = 0;
  for (let mebibytes = 8; mebibytes <= 340; mebibytes += 24) {
    const { code, signal, err } = await runAfter(`ulimit -d ${mebibytes * 1024}`, folder, "render", "a.json", "-t", "2");
    if (code === 0) break;
    assert.equal(code, 71, `${mebibytes} MiB: ${signal} ${err}`);
    assert.equal(stateOf(folder).state, "interrupted");
    assert.deepEqual(temporaries(folder), []);
    ++short;
  }
  assert.ok(short > 0, "the least of these limits is too little");
  assert.equal((await run(folder, "render", "a.json", "-q")).code, 0);
});
