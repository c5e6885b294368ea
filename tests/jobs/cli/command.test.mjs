import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, statSync, symlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { job, root, run, temporaryFolder } from "./command.mjs";

test("help and version", async (t) => {
  const folder = temporaryFolder(t);
  const help = await run(folder, "--help");
  assert.equal(help.code, 0);
  for (const word of ["render", "check", "schema", "extend", "list", "compare", "figure", "cache", "71 out of memory", "75 interrupted"]) assert.ok(help.out.includes(word), word);
  assert.match((await run(folder, "--version")).out, /^lacuna \d+\.\d+\.\d+\n$/);
  assert.equal((await run(folder, "paint")).code, 2);
  assert.equal((await run(folder)).code, 2);
});

test("render: results, a line a milestone, done already, another job in the way", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  const first = await run(folder, "render", "a.json");
  assert.equal(first.code, 0, first.err);
  for (const name of ["image.exr", "image.png", "layers.half", "layers.json", "curve.csv", "report.json", "job.json", "outcome.json", "log.txt"]) {
    assert.ok(existsSync(join(folder, "a.job", name)), name);
  }
  assert.match(first.err, /iteration 2, /);
  const again = await run(folder, "render", "a.json");
  assert.equal(again.code, 0);
  assert.match(again.err, /already done/);
  job(folder, "b.json", { seed: 7 });
  const other = await run(folder, "render", "b.json", "--out", "a.job");
  assert.equal(other.code, 2);
  assert.match(other.err, /contains another job/);
  writeFileSync(join(folder, "file"), "mine");
  assert.equal((await run(folder, "render", "b.json", "--out", "file")).code, 2);
  assert.equal(readFileSync(join(folder, "file"), "utf8"), "mine");
});

test("check prints the job with its defaults, which is the same job", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  const checked = await run(folder, "check", "a.json");
  assert.equal(checked.code, 0, checked.err);
  writeFileSync(join(folder, "full.json"), checked.out);
  assert.equal((await run(folder, "check", "full.json")).out, checked.out);
  assert.equal(JSON.parse(checked.out).integrator.type, "path");
});

test("check and analyze take the pose and the variant that a job would", async (t) => {
  const folder = temporaryFolder(t);
  const floats = (...numbers) => Buffer.from(new Float32Array(numbers).buffer);
  const bin = Buffer.concat([floats(0, 0, 0, 1, 0, 0, 0, 1, 0), floats(0, 1), floats(0, 0, 0, 0, 0, 8)]);
  const view = (byteOffset, byteLength) => ({ buffer: 0, byteOffset, byteLength });
  const accessor = (bufferView, count, type) => ({ bufferView, count, type, componentType: 5126 });
  writeFileSync(join(folder, "moves.gltf"), JSON.stringify({ asset: { version: "2.0" },
    scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    animations: [{ name: "away", channels: [{ sampler: 0, target: { node: 0, path: "translation" } }],
      samplers: [{ input: 1, output: 2 }] }],
    accessors: [accessor(0, 3, "VEC3"), { ...accessor(1, 2, "SCALAR"), min: [0], max: [1] }, accessor(2, 2, "VEC3")],
    bufferViews: [view(0, 36), view(36, 8), view(44, 24)],
    buffers: [{ byteLength: bin.length, uri: `data:application/octet-stream;base64,${bin.toString("base64")}` }] }));
  const box = async (...choice) => /box: (.*)/.exec((await run(folder, "check", "--scene", "moves.gltf", ...choice)).out)?.[1];
  assert.equal(await box(), "[0, 0, 0] to [1, 1, 0]");
  assert.equal(await box("--time", "0.5", "--animation", "away"), "[0, 0, 4] to [1, 1, 4]");
  const without = await run(folder, "check", "--scene", "moves.gltf", "--animation", "away");
  assert.equal(without.code, 2, "an animation without a time");
  for (const command of [["check", "--scene", "moves.gltf"], ["analyze", "moves.gltf"]]) {
    const unknown = await run(folder, ...command, "--variant", "red");
    assert.equal(unknown.code, 3, unknown.err);
    assert.match(unknown.err, /there is no variant "red"/);
  }
});

test("check --scene: what a scene holds, or why it is none", async (t) => {
  const folder = temporaryFolder(t);
  const good = await run(folder, "check", "--scene", join(root, "jobs/scenes/cornell.glb"));
  assert.equal(good.code, 0, good.err);
  assert.match(good.out, /^cornell\.glb: [1-9]\d* triangles, [1-9]\d* materials, \d+ textures, [1-9]\d* cameras, \d+ lights\n  box: \[[-.e\d]+, [-.e\d]+, [-.e\d]+\] to \[/);
  assert.match(good.out, /^  metallic-roughness +exact +GGX /m, "what of glTF it uses");
  assert.match(good.out, /^  ".+": \{"position": \[.*\], "target": \[.*\], "up": \[.*\], "fov": [\d.]+\}$/m, "its cameras");
  const features = await run(folder, "check", "--features");
  assert.ok(readFileSync(join(root, "docs/scenes.md"), "utf8").endsWith(features.out), "docs/scenes.md: ./dev docs");
  writeFileSync(join(folder, "noise.glb"), "glTF but no more than that");
  const bad = await run(folder, "check", "--scene", "noise.glb");
  assert.equal(bad.code, 3);
  assert.match(bad.err, /noise\.glb/);
  assert.equal(bad.out, "");
  writeFileSync(join(folder, "mesh.obj"), "v 0 0 0\n");
  writeFileSync(join(folder, "mesh.gltf"), "v 0 0 0\n");
  const other = await run(folder, "check", "--scene", "mesh.obj");
  assert.equal(other.code, 3);
  assert.match(other.err, /"mesh\.obj" ends in "\.obj"; allowed: \.glb and \.gltf; .*`assimp export mesh\.obj mesh\.glb`/);
  const broken = await run(folder, "check", "--scene", "mesh.gltf");
  assert.match(broken.err, /JSON: it breaks off, or is none, at byte 1/);
  assert.doesNotMatch(broken.err, /exception|parse_error|literal/);
  assert.equal((await run(folder, "check", "--scene", "nowhere.glb")).code, 2);
  assert.equal((await run(folder, "check")).code, 2, "a job or a scene");
  job(folder, "a.json", {});
  assert.equal((await run(folder, "check", "a.json", "--scene", "noise.glb")).code, 2, "not both");
});

test("schema and settings pages", async (t) => {
  const folder = temporaryFolder(t);
  const schema = JSON.parse((await run(folder, "schema")).out);
  assert.equal(schema.$schema, "https://json-schema.org/draft/2020-12/schema");
  assert.ok(schema.required.includes("scene"));
  assert.match((await run(folder, "schema", "--markdown")).out, /roulette_depth/);
});

test("list: scenes and jobs", async (t) => {
  const folder = temporaryFolder(t);
  assert.match((await run(folder, "list", "--scenes")).out, /^cornell\.glb$/m);
  assert.equal((await run(folder, "list")).code, 0);
  job(folder, "b.json", { label: "second" });
  job(folder, "a.json", { label: "first" });
  for (const name of ["a", "b"]) assert.equal((await run(folder, "render", `${name}.json`, "-q")).code, 0);
  assert.equal((await run(folder, "render", "a.json", "-q", "--out", "others/x")).code, 0);
  const names = async (...what) => (await run(folder, "list", ...what)).out.trimEnd().split("\n").slice(1)
    .map((line) => line.split(/ +/).slice(0, 2).join(" "));
  assert.deepEqual(await names(), ["a.job done", "b.job done"]);
  assert.deepEqual(await names("b.job", "others"), ["b.job done", "others/x done"]);
  mkdirSync(join(folder, "empty"));
  const none = await run(folder, "list", "empty");
  assert.equal(none.code, 2);
  assert.match(none.err, /empty is not a job's folder and contains none/);
});

test("extend: a done job goes on from its checkpoint to the bits of one run", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  job(folder, "whole.json", { budget: { iterations: 5 } });
  for (const name of ["a", "whole"]) assert.equal((await run(folder, "render", `${name}.json`, "-q")).code, 0);
  const smaller = await run(folder, "extend", "a.job", "--iterations", "1");
  assert.equal(smaller.code, 2);
  assert.match(smaller.err, /\/budget\/iterations: found 1; allowed: at least 2/);
  assert.match((await run(folder, "extend", "a.job")).err, /sets no limit/);
  assert.match((await run(folder, "extend", "a.job", "--seconds", "-1")).err, /\/budget\/seconds.*-1/);
  assert.match((await run(folder, "extend", "a.job", "--error", "0.1")).err, /the job has no error target/);
  const same = JSON.parse(readFileSync(join(folder, "a.job/job.json"), "utf8"));
  assert.deepEqual(same.budget.iterations, 2, "what is refused changes nothing");
  assert.equal(JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8")).state, "done");
  const extended = await run(folder, "extend", "a.job", "--iterations", "5");
  assert.equal(extended.code, 0, extended.err);
  assert.match(extended.err, /continuing from iteration 2/);
  assert.match((await run(folder, "compare", "a.job/image.exr", "whole.job/image.exr")).out, /^mse +0$/m);
});

test("render: errors that the reference's own noise bounds are marked", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { reference: "auto", reference_iterations: 16, budget: { iterations: 200 } });
  const done = await run(folder, "render", "a.json");
  assert.equal(done.code, 0, done.err);
  assert.match(done.err, /^iteration 200, .*, at the reference's noise$/m);
  assert.equal(done.err.match(/^the reference's own noise, rmse \S+, is more than half of the mse/gm)?.length, 1);
});

test("the service's documentation holds the state machine as it is", async (t) => {
  const states = await run(temporaryFolder(t), "schema", "--states");
  assert.equal(states.code, 0);
  assert.match(states.out, /\| `held` \| `queued` \| person \|/);
  const page = readFileSync(new URL("../../../docs/service.md", import.meta.url), "utf8");
  assert.ok(page.endsWith(states.out), "docs/service.md ends with what `lacuna schema --states` prints");
});

test("compare: equal pictures, different ones, other sizes", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", { layers: ["variance"] });
  job(folder, "b.json", { seed: 2, layers: ["variance"] });
  job(folder, "c.json", { resolution: [8, 8] });
  for (const name of ["a", "b", "c"]) assert.equal((await run(folder, "render", `${name}.json`, "-q")).code, 0);
  const same = await run(folder, "compare", "a.job/image.exr", "a.job/image.exr");
  assert.match(same.out, /^mse +0$/m);
  const different = await run(folder, "compare", "a.job/image.exr", "b.job/image.exr", "--block", "4");
  assert.match(different.out, /^mse +[0-9.e-]*[1-9]/m);
  assert.match(different.out, /z_deviation/);
  assert.match(same.out, /^flip +0$/m);
  assert.match(same.out, /^display_flip 0$/m);
  assert.match(different.out, /^flip +0\.[0-9]*[1-9]/m);
  const map = async (...rest) => run(folder, "compare", "a.job/image.exr", "b.job/image.exr", "--map", ...rest);
  assert.match((await map("map.png")).out, /^map_largest 1$/m);
  assert.equal(readFileSync(join(folder, "map.png")).readUInt32BE(16), 24, "its width");
  assert.equal((await map("map.exr", "--metric", "mse")).code, 0);
  assert.ok(statSync(join(folder, "map.exr")).size > 0);
  assert.match((await map("map.jpg")).err, /"map\.jpg" is no \.png or \.exr/);
  const unknown = await map("map.png", "--metric", "psnr");
  assert.equal(unknown.code, 2);
  assert.match(unknown.err, /psnr.*flip/s);
  // The sum of the squared differences of the whole is that of its halves.
  const mse = async (...crop) => {
    const { out, err } = await run(folder, "compare", "a.job/image.exr", "b.job/image.exr", ...crop);
    return Number(/^mse +(\S+)$/m.exec(out)?.[1] ?? assert.fail(err));
  };
  const halves = [await mse("--crop", "0", "0", "24", "8"),
    await mse("--crop", "0", "8", "24", "8")];
  assert.ok(halves[0] !== halves[1]);
  assert.ok(Math.abs((halves[0] + halves[1]) / 2 - await mse()) <= 1e-8 * await mse());
  const outside = await run(folder, "compare", "a.job/image.exr", "b.job/image.exr", "--crop", "1", "0",
    "24", "1");
  assert.equal(outside.code, 3);
  assert.match(outside.err, /--crop 1 0 24 1 is not inside the pictures, 24 x 16/);
  const sizes = await run(folder, "compare", "a.job/image.exr", "c.job/image.exr");
  assert.equal(sizes.code, 3);
  assert.match(sizes.err, /24 x 16.*8 x 8/);
});

test("compare and a reference: a value that is not finite is named, not averaged", async (t) => {
  const folder = temporaryFolder(t);
  const good = join(root, "tests/fuzz/corpus/float_image/none.exr"); // 7 x 5, half floats, not compressed
  const bytes = readFileSync(good);
  bytes.writeUInt16LE(0x7e00, bytes.length - 2); // of the last pixel R: NaN
  writeFileSync(join(folder, "nan.exr"), bytes);
  const place = /nan\.exr.*: pixel \(6, 4\) channel R is nan, the first of 1 such values of 105; allowed: finite/;
  for (const pair of [["nan.exr", good], [good, "nan.exr"], ["nan.exr", "nan.exr"]]) {
    const { code, out, err } = await run(folder, "compare", ...pair);
    assert.equal(code, 3, out);
    assert.match(err, place);
    assert.equal(out, "");
  }
  assert.equal((await run(folder, "compare", "nan.exr", good, "--crop", "0", "0", "7", "4")).code, 0);
  job(folder, "r.json", { resolution: [7, 5], reference: "nan.exr" });
  const refused = await run(folder, "render", "r.json", "-q");
  assert.equal(refused.code, 3);
  assert.match(refused.err, place);
});

// What is wrong with it, the job file, what the message must name.
const badJobs = [
  ["malformed JSON", '{"scene": "cornell.glb",', /line 1/],
  ["not an object", "[1]", /object/],
  ["unknown key", { integratr: "path" }, /\/integratr.*integrator/s],
  ["duplicate key", '{"scene": "cornell.glb", "seed": 1, "seed": 2}', /\/seed/],
  ["no scene", '{"resolution": [8, 8]}', /\/scene/],
  ["out of range", { resolution: [0, 16] }, /\/resolution\/0.*0/s],
  ["wrong type", { threads: "two" }, /\/threads.*"two"/s],
  ["not a number", '{"scene": "cornell.glb", "budget": {"seconds": NaN}}', /line 1/],
  ["negative", { seed: -1 }, /\/seed.*-1/s],
  ["a fraction", { budget: { iterations: 1.5 } }, /\/budget\/iterations.*1\.5/s],
  ["unknown integrator", { integrator: { type: "bidir" } }, /\/integrator\/type.*path/s],
  ["deep nesting", `{"scene": ${"[".repeat(100000)}`, /nest|deep/],
  ["an error target without a reference", { budget: { error: { metric: "mse", target: 0.1 } } }, /reference/],
];
for (const [what, content, message] of badJobs) {
  test(`bad job: ${what}: exit 2, and no folder`, async (t) => {
    const folder = temporaryFolder(t);
    job(folder, "a.json", content);
    const result = await run(folder, "render", "a.json");
    assert.equal(result.code, 2, result.err);
    assert.match(result.err, message);
    assert.ok(!existsSync(join(folder, "a.job")));
  });
}

const badAssets = [
  ["a scene that is not there", { scene: "cornel.glb" }, /cornel\.glb/],
  ["a scene above its root", { scene: "../secret.glb" }, /\.\.\/secret\.glb/],
  ["an absolute scene", { scene: "/etc/passwd.glb" }, /passwd/],
  ["a scene through a link", { scene: "link.glb" }, /link\.glb/],
  ["a file that is no glTF", { scene: "noise.glb" }, /noise\.glb/],
  ["a camera that is not there", { camera: "left" }, /"left".*"front"/s],
  ["an environment that is no image", { scene: "open.glb", environment: { file: "noise.hdr" } }, /noise\.hdr/],
  ["a reference of another size", { reference: "small.job/image.exr" }, /8 x 8/],
];
for (const [what, content, message] of badAssets) {
  test(`bad asset: ${what}: exit 3, state failed with the reason`, async (t) => {
    const folder = temporaryFolder(t);
    symlinkSync(join(root, "jobs/scenes/cornell.glb"), join(folder, "link.glb"));
    writeFileSync(join(folder, "noise.glb"), "glTF but no more than that");
    writeFileSync(join(folder, "noise.hdr"), "#?RADIANCE and no more than that");
    if (content.reference) {
      job(folder, "small.json", { resolution: [8, 8] });
      assert.equal((await run(folder, "render", "small.json", "-q")).code, 0);
    }
    job(folder, "a.json", content);
    const result = await run(folder, "render", "a.json");
    assert.equal(result.code, 3, result.err);
    assert.match(result.err, message);
    const state = JSON.parse(readFileSync(join(folder, "a.job/outcome.json"), "utf8"));
    assert.equal(state.state, "failed");
    assert.match(state.error, message);
  });
}

test("a folder that cannot be made", async (t) => {
  const folder = temporaryFolder(t);
  job(folder, "a.json", {});
  const result = await run(folder, "render", "a.json", "--out", "a.json/below");
  assert.notEqual(result.code, 0);
  assert.match(result.err, /a\.json/);
});
