// lacuna trace, and the layers of light: the paths of a pixel are those of the job's picture.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { job, run, temporaryFolder } from "./command.mjs";

const small = { scene: "cornell.glb", resolution: [16, 12], budget: { iterations: 8 } };

/// The values of a layer of a job at a pixel.
function valueAt(folder, name, [x, y]) {
  const index = JSON.parse(readFileSync(join(folder, "layers.json")));
  const layer = index.layers.find((l) => l.name === name);
  const bytes = readFileSync(join(folder, "layers.half"));
  const half = (at) => {
    const bits = bytes.readUInt16LE(at), exponent = bits >> 10 & 31, fraction = bits & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    return (bits >> 15 ? -size : size) * layer.scale;
  };
  const first = layer.offset + 6 * (y * index.width + x);
  return [0, 1, 2].map((k) => half(first + 2 * k));
}

const near = (found, expected) => found.forEach((v, k) =>
  assert.ok(Math.abs(v - expected[k]) <= 2e-3 * Math.max(...expected) + 1e-9, `${found}, not ${expected}`));

test("the mean of a pixel's paths is the pixel, by each method that is traced", async (t) => {
  const folder = temporaryFolder(t);
  for (const [name, integrator] of Object.entries({
    path: { type: "path" }, guided: { type: "path", guide: "sd_tree" }, light: { type: "light" },
    bdpt: { type: "bdpt" } })) {
    job(folder, `${name}.json`, { ...small, integrator, layers: ["lengths"] });
    const rendered = await run(folder, "render", `${name}.json`);
    assert.equal(rendered.code, 0, rendered.err);
    const told = await run(folder, "trace", `${name}.json`, "--pixel", "7,9", "--samples", "8", "--brightest", "100000",
      "--json");
    assert.equal(told.code, 0, told.err);
    const found = JSON.parse(told.out);
    assert.equal(found.count, found.paths.length);
    const job_folder = join(folder, `${name}.job`);
    const picture = valueAt(job_folder, "", [7, 9]);
    near(found.mean, picture);
    const sums = {};
    for (const path of found.paths) {
      assert.match(path.letters, /^E[DGS]*L$/);
      assert.equal(path.letters.length, path.s + path.t);
      assert.ok(path.vertices.length === 0 || path.vertices.length === path.letters.length);
      assert.ok(path.weight > 0 && path.weight < 1 + 1e-6);
      assert.ok(path.iteration < 8);
      const sum = sums[path.letters.length - 1] ??= [0, 0, 0];
      path.value.forEach((v, k) => { sum[k] += v / 8; });
    }
    near(Object.values(sums).reduce((all, s) => all.map((v, k) => v + s[k])), picture);
    for (const [edges, sum] of Object.entries(sums)) near(sum, valueAt(job_folder, `lengths.${edges}`, [7, 9]));
  }
});

test("a table, and the paths over the scene", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", small);
  const told = await run(folder, "trace", "a.json", "--pixel", "7,9", "--samples", "4", "--brightest", "2", "--glb", "a.glb");
  assert.equal(told.code, 0, told.err);
  assert.match(told.out, /^pixel 7, 9: mean .* over 4 samples, seed 1; \d+ paths contribute$/m);
  assert.equal(told.out.match(/MIS weight/g).length, 2);
  assert.match(told.out, /density \S+ per area/);
  assert.ok(existsSync(join(folder, "a.glb")));
  const opened = await run(folder, "check", "--scene", "a.glb");
  assert.equal(opened.code, 0, opened.err);
});

test("what cannot be traced is refused by name", async (t) => {
  const folder = temporaryFolder(t);
  const refused = async (integrator, ...options) => {
    job(folder, "a.json", { ...small, integrator });
    const told = await run(folder, "trace", "a.json", ...options);
    assert.equal(told.code, 2, told.out);
    return told.err;
  };
  assert.match(await refused({ type: "sppm" }, "--pixel", "1,1"), /found "sppm".*allowed: "path", "light", "bdpt"/);
  assert.match(await refused({ type: "path", reuse: 16 }, "--pixel", "1,1"), /reuse/);
  assert.match(await refused({ type: "bdpt", connections: "uniform" }, "--pixel", "1,1"), /paired/);
  assert.match(await refused({ type: "path" }, "--pixel", "16,1"), /column 16; allowed: 0 to 15/);
  assert.match(await refused({ type: "path" }, "--pixel", "1,-1"), /row -1; allowed: 0 to 11/);
  assert.match(await refused({ type: "path" }, "--pixel", "1,1", "--samples", "9"), /found 9; allowed: 1 to 8/);
});
