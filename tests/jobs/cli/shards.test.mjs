// Shards of a job, rendered apart and merged, against one machine.

import assert from "node:assert/strict";
import { cpSync, existsSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";

import { job, root, run, start, temporaryFolder } from "./command.mjs";

const spec = { scene: "ajar.glb", resolution: [48, 32], budget: { iterations: 21 }, layers: ["variance", "halves"] };
const read = (folder, name) => JSON.parse(readFileSync(join(folder, name), "utf8"));
const names = (n) => Array.from({ length: n }, (_, k) => `a.${String(k + 1).padStart(String(n).length, "0")}-of-${n}.job`);

async function done(folder, ...args) {
  const ended = await run(folder, ...args, "-q");
  assert.equal(ended.code, 0, ended.err);
  return ended;
}

/// Renders all shards of a.json.
async function shards(folder, n) {
  for (let k = 1; k <= n; ++k) await done(folder, "render", "a.json", "--shard", `${k}/${n}`);
  return names(n);
}

/// Of the pictures every bit, of their other layers what halves hold.
async function sameBits(folder, a, b) {
  const { out, code } = await run(folder, "compare", join(a, "image.exr"), join(b, "image.exr"));
  assert.equal(code, 0);
  assert.match(out, /^mse +0$/m);
  assert.deepEqual(readFileSync(join(folder, a, "layers.half")), readFileSync(join(folder, b, "layers.half")));
}

test("1, 2, 3 and 8 shards in any order: the bits of one machine, and the same when extended", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  await done(folder, "render", "a.json");
  await done(folder, "render", "a.json", "--out", "longer.job");
  await done(folder, "extend", "longer.job", "--iterations", "30");
  const whole = read(folder, "a.job/report.json");
  for (const n of [1, 2, 3, 8]) {
    const made = await shards(folder, n);
    for (const [out, order] of [["up", made], ["down", [...made].reverse()]]) {
      const merged = `${out}${n}.job`;
      await done(folder, "merge", merged, ...order);
      await sameBits(folder, "a.job", merged);
      const report = read(folder, `${merged}/report.json`);
      assert.deepEqual(report.counts, whole.counts);
      assert.equal(report.errors.est_rmse, whole.errors.est_rmse);
      assert.equal(report.merged.same_bits_as_one_machine, true);
      assert.equal(report.merged.shards, n);
      assert.equal(report.sums_exact, true);
      assert.equal(read(folder, `${merged}/job.json`).shard, 0);
    }
    await done(folder, "extend", `up${n}.job`, "--iterations", "30");
    await sameBits(folder, "longer.job", `up${n}.job`);
    assert.equal(read(folder, `up${n}.job/report.json`).merged.shards, n, "it still says where it comes from");
  }
});

test("clocks: seconds are the sum, longest_seconds the longest", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, budget: { iterations: 400 } });
  const made = await shards(folder, 3);
  await done(folder, "merge", "m.job", ...made);
  const curve = (name) => {
    const [head, ...rows] = readFileSync(join(folder, name, "curve.csv"), "utf8").trim().split("\n").map((l) => l.split(","));
    return rows.map((row) => Object.fromEntries(head.map((key, i) => [key, Number(row[i])])));
  };
  const ends = made.map((name) => curve(name).at(-1));
  const merged = curve("m.job");
  const near = (a, b) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.abs(b), `${a}, not ${b}`);
  near(merged.at(-1).seconds, ends.reduce((sum, row) => sum + row.seconds, 0));
  near(merged.at(-1).cpu_seconds, ends.reduce((sum, row) => sum + row.cpu_seconds, 0));
  near(merged.at(-1).longest_seconds, Math.max(...ends.map((row) => row.seconds)));
  assert.equal(merged.at(-1).iteration, 400);
  // It begins as the first shard's does.
  assert.deepEqual(merged[0], curve(made[0])[0]);
  for (const [i, row] of merged.slice(1).entries()) {
    assert.ok(row.iteration > merged[i].iteration && row.seconds > merged[i].seconds);
  }
});

test("budgets of time: shards of different lengths merge, and what is missing is rendered first", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, budget: { seconds: 0.2 } });
  const made = await shards(folder, 2);
  await done(folder, "merge", "m.job", ...made);
  const counts = made.map((name) => read(folder, `${name}/report.json`).counts.iterations);
  assert.equal(read(folder, "m.job/report.json").counts.iterations, counts[0] + counts[1]);
  // Enough to close every gap: then it is the picture of one machine.
  const enough = 4 * Math.max(...counts) + 8;
  await done(folder, "extend", "m.job", "--iterations", String(enough));
  job(folder, "one.json", { ...spec, budget: { iterations: enough } });
  await done(folder, "render", "one.json");
  await sameBits(folder, "one.job", "m.job");
  assert.equal(read(folder, "m.job/report.json").merged.same_bits_as_one_machine, true);
});

test("a method that learns: merged by weight, and the report says so", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, integrator: { type: "path", guide: { type: "sd_tree" } } });
  const made = await shards(folder, 3);
  await done(folder, "merge", "m.job", ...made);
  const report = read(folder, "m.job/report.json");
  assert.equal(report.merged.learned_apart, true);
  assert.equal(report.merged.same_bits_as_one_machine, false);
  assert.ok(report.merged.est_rmse > 0);
  await done(folder, "extend", "m.job", "--iterations", "25");
  assert.equal(read(folder, "m.job/report.json").counts.iterations, 25);
});

test("metropolis has no state: the same bits", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { ...spec, integrator: { type: "metropolis" }, budget: { iterations: 7 } });
  await done(folder, "render", "a.json");
  const made = await shards(folder, 3);
  await done(folder, "merge", "m.job", ...made);
  await sameBits(folder, "a.job", "m.job");
});

test("a shard that is killed goes on to the same bits", async (t) => {
  const folder = temporaryFolder(t);
  const longer = { ...spec, resolution: [160, 120], budget: { iterations: 60 }, checkpoint_seconds: 0.05 };
  job(folder, "a.json", longer);
  await done(folder, "render", "a.json");
  for (const k of [1, 2]) {
    const killed = start(folder, "render", "a.json", "--shard", `${k}/2`, "-q");
    while (!existsSync(join(folder, names(2)[k - 1], "checkpoint.bin")) && killed.child.exitCode === null) await pause(5);
    killed.child.kill("SIGKILL");
    assert.equal((await killed.ended).signal, "SIGKILL");
    const early = await run(folder, "merge", "early.job", ...names(2).slice(0, k));
    assert.equal(early.code, 2);
    assert.match(early.err, new RegExp(`shard ${k} of 2 is running, not done`));
    await done(folder, "render", names(2)[k - 1]);
  }
  await done(folder, "merge", "m.job", ...names(2));
  await sameBits(folder, "a.job", "m.job");
});

test("what makes no picture is refused by name", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  const made = await shards(folder, 3);
  const refused = async (pattern, ...args) => {
    const { code, err } = await run(folder, "merge", ...args);
    assert.equal(code, 2, err);
    assert.match(err, pattern);
    assert.ok(!existsSync(join(folder, "m.job")));
  };
  await refused(/missing shards of 3: 2\b/, "m.job", made[0], made[2]);
  await refused(/a\.2-of-3\.job: shard 2 of 3 is a duplicate of .*a\.2-of-3\.job/, "m.job", ...made, made[1]);
  cpSync(join(folder, made[1]), join(folder, "copy.job"), { recursive: true });
  await refused(/copy\.job: shard 2 of 3 is a duplicate of .*a\.2-of-3\.job/, "m.job", ...made, "copy.job");
  await done(folder, "render", "a.json");
  await refused(/a\.job: a whole job; allowed: its shards/, "m.job", "a.job", ...made);
  await refused(/exists; allowed: a new folder/, made[0], ...made);

  const another = async (change, pattern) => {
    job(folder, "b.json", { ...spec, ...change });
    await done(folder, "render", "b.json", "--shard", "2/3");
    await refused(pattern, "m.job", made[0], "b.2-of-3.job", made[2]);
    rmSync(join(folder, "b.2-of-3.job"), { recursive: true });
  };
  await another({ seed: 7 }, /b\.2-of-3\.job: seed is 7; allowed: 1, as in .*a\.1-of-3\.job/);
  await another({ budget: { iterations: 23 } }, /budget is .*23.*; allowed: .*21/);
  await another({ integrator: { type: "light" } }, /integrator is .*"light"/);
  await another({ layers: ["variance"] }, /layers is \["variance"\]/);
  job(folder, "b.json", spec);
  await done(folder, "render", "b.json", "--shard", "2/4");
  await refused(/shards is 4; allowed: 3, as in/, "m.job", made[0], "b.2-of-4.job", made[2]);

  // The same name, another scene.
  const scene = readFileSync(join(root, "jobs/scenes/cornell.glb"));
  job(folder, "c.json", { ...spec, scene: "own.glb", budget: { iterations: 4 } });
  writeFileSync(join(folder, "own.glb"), scene);
  await done(folder, "render", "c.json", "--shard", "1/2");
  scene[scene.indexOf("CC0") + 2] = "1".charCodeAt();
  writeFileSync(join(folder, "own.glb"), scene);
  await done(folder, "render", "c.json", "--shard", "2/2");
  await refused(/c\.2-of-2\.job: scene "own\.glb" has changed contents of the same size in .*c\.1-of-2\.job; allowed/,
    "m.job", "c.1-of-2.job", "c.2-of-2.job");
});

test("a damaged shard, and one of another version, are named", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  const made = await shards(folder, 2);
  const file = join(folder, made[1], "checkpoint.bin");
  const whole = readFileSync(file);
  const attempt = async (bytes, code, pattern) => {
    writeFileSync(file, bytes);
    const ended = await run(folder, "merge", "m.job", ...made);
    assert.equal(ended.code, code, ended.err);
    assert.match(ended.err, pattern);
  };
  const flipped = Buffer.from(whole);
  flipped[whole.length >> 1] ^= 1;
  await attempt(flipped, 1, /shard 2 of 2 \(.*a\.2-of-2\.job\): .*checkpoint\.bin: damaged/);
  assert.equal(read(folder, "m.job/outcome.json").state, "failed");
  await attempt(whole.subarray(0, whole.length - 100), 1, /shard 2 of 2 .*truncated/);
  await attempt(Buffer.alloc(3), 2, /a\.2-of-2\.job: .*checkpoint\.bin: /);
  const version = read(folder, "a.2-of-2.job/report.json").version;
  const at = whole.indexOf(version);
  const other = Buffer.from(whole);
  other[at] ^= 1;
  await attempt(other, 2, /a\.2-of-2\.job: the version is .*; allowed: .*, as in .*a\.1-of-2\.job/);
  rmSync(file);
  const gone = await run(folder, "merge", "m.job", ...made);
  assert.equal(gone.code, 2, gone.err);
  assert.match(gone.err, /a\.2-of-2\.job: .*checkpoint\.bin/);
  // With the shard whole again, the same command makes the same folder.
  writeFileSync(file, whole);
  await done(folder, "merge", "m.job", ...made);
  await done(folder, "render", "a.json");
  await sameBits(folder, "a.job", "m.job");
});

test("shards of another kind of processor are merged with a warning", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  const made = await shards(folder, 2);
  const file = join(folder, made[1], "report.json");
  const report = read(folder, `${made[1]}/report.json`);
  writeFileSync(file, JSON.stringify({ ...report, machine: { ...report.machine, processor: "Another 9000" } }));
  await done(folder, "merge", "m.job", ...made);
  const [warning] = read(folder, "m.job/outcome.json").warnings.filter((w) => /processor models/.test(w));
  assert.match(warning, /on 2 processor models \(.*Another 9000.*\): their last bits may differ/);
});

test("--shard: bad values, and what a job says itself", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", spec);
  const refused = async (pattern, ...args) => {
    const { code, err } = await run(folder, "render", ...args);
    assert.equal(code, 2, err);
    assert.match(err, pattern);
  };
  for (const bad of ["0/3", "4/3", "3", "x/3", "1/3x", "-1/3", "1/99999999"]) await refused(/shard/, "a.json", "--shard", bad);
  await refused(/shard 12 of 12 has none of 21 iterations.*; allowed: 1 to 11 shards/, "a.json", "--shard", "12/12");
  job(folder, "eight.json", { ...spec, shards: 8 });
  await refused(/the job has 8 shards; allowed: 1\/8 to 8\/8/, "eight.json", "--shard", "1/3");
  await done(folder, "render", "eight.json", "--shard", "1/8");
  await refused(/is a folder, which has its shard/, "eight.1-of-8.job", "--shard", "1/8");
  job(folder, "bad.json", { ...spec, shards: 2, shard: 3 });
  await refused(/\/shard: found 3; allowed: 0 to 2/, "bad.json");
});
