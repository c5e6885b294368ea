// `lacuna analyze`: the shape of a scene's empty space as a table, as JSON and as overlays; what a
// job takes from the same cache.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { run, temporaryFolder } from "./command.mjs";

const quick = ["analyze", "ajar.glb", "--resolution", "48"];

test("analyze: a table, and the second time all of it from the cache", async (t) => {
  const folder = temporaryFolder(t);
  const first = await run(folder, ...quick);
  assert.equal(first.code, 0, first.err);
  assert.match(first.out, /^grid +\[\d+,\d+,48\]$/m);
  assert.match(first.out, /^skeleton +built +\d/m);
  assert.equal(/ loaded /.test(first.out), false);
  const second = await run(folder, ...quick, "--json");
  const again = JSON.parse(second.out);
  assert.deepEqual(new Set(again.steps.map((s) => s.origin)), new Set(["loaded"]));
  assert.ok(again.nodes > again.filtered_nodes && again.filtered_nodes > 0);
  assert.equal(again.dropped_components > 0, true, "the space inside closed furniture is dropped");
  const anew = JSON.parse((await run(folder, ...quick, "--json", "--no-cache", "--threads", "1")).out);
  assert.deepEqual(new Set(anew.steps.map((s) => s.origin)), new Set(["built"]));
  for (const key of ["nodes", "loops", "components", "regions", "portals", "gates"]) {
    assert.equal(anew[key], again[key], key);
  }
});

test("analyze: overlays are scenes that can be rendered", async (t) => {
  const folder = temporaryFolder(t);
  const out = join(folder, "shapes");
  assert.equal((await run(folder, ...quick, "--out", out)).code, 0);
  for (const name of ["skeleton", "filtered", "clusters", "gates", "portals"]) {
    const checked = await run(folder, "check", "--scene", join(out, `${name}.glb`));
    assert.equal(checked.code, 0, checked.err);
    assert.match(checked.out, new RegExp(`^${name}\\.glb: \\d+ triangles, [1-9]\\d* materials, 0 textures, [1-9]`));
  }
});

test("analyze: the radii of voxels and alpha, by their options", async (t) => {
  const folder = temporaryFolder(t);
  const shape = async (...options) => JSON.parse((await run(folder, ...quick, "--json", ...options)).out);
  const corner = await shape(), voxel = await shape("--node-radius", "voxel");
  assert.ok(corner.gates_of_radius_0 > 0 && corner.gates_of_radius_0 < corner.gates, JSON.stringify(corner));
  assert.equal(voxel.gates_of_radius_0, 0);
  assert.equal(voxel.nodes, corner.nodes);
  assert.notEqual(voxel.filtered_nodes, corner.filtered_nodes);
  const wide = await shape("--cluster-alpha", "1");
  assert.deepEqual(new Set(wide.steps.filter((s) => s.origin === "built").map((s) => s.name)),
    new Set(["visibility_clusters", "visibility_gates"]));
  assert.notEqual(wide.clusters, corner.clusters);
  for (const alpha of ["-0.1", "1.5", "nan"]) {
    const refused = await run(folder, ...quick, "--cluster-alpha", alpha);
    assert.equal(refused.code, 2, alpha);
    assert.match(refused.err, /--cluster-alpha/);
  }
});

test("analyze: what cannot be is said", async (t) => {
  const folder = temporaryFolder(t);
  const missing = await run(folder, "analyze", "nowhere.glb");
  assert.notEqual(missing.code, 0);
  assert.match(missing.err, /nowhere\.glb/);
  const large = await run(folder, "analyze", "ajar.glb", "--resolution", "3000");
  assert.equal(large.code, 2);
  assert.match(large.err, /--resolution/);
});

test("inspect: a job finds in the cache what analyze has left, and its report says so", async (t) => {
  const folder = temporaryFolder(t);
  assert.equal((await run(folder, ...quick)).code, 0);
  const report = async (show) => {
    const job = join(folder, `${show}.json`);
    writeFileSync(job, JSON.stringify({
      scene: "ajar.glb", camera: "room", resolution: [64, 48], budget: { iterations: 2 },
      analysis: { resolution: 48 }, integrator: { type: "inspect", show },
    }));
    const done = await run(folder, "render", job);
    assert.equal(done.code, 0, done.err);
    return JSON.parse(readFileSync(join(folder, `${show}.job`, "report.json"), "utf8"));
  };
  const mapped = (await report("filtered_mapping")).artefacts;
  assert.deepEqual(mapped.built, []);
  assert.ok(mapped.loaded.some((a) => a.name === "filtered_map"));
  assert.ok(mapped.left_out.includes("portals"));
  const plain = (await report("normal")).artefacts;
  assert.deepEqual([plain.built, plain.loaded], [[], []], "nothing is analysed that nobody asks for");
  for (const show of ["node_mapping", "opening", "region_labels", "visibility_clusters", "nearest_node_visible"]) {
    assert.deepEqual((await report(show)).artefacts.built, [], show);
  }
});
