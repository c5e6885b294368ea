// `lacuna import`: a scene of Mitsuba becomes a folder that renders; what is missing is named.

import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { run, temporaryFolder } from "./command.mjs";

const scene = (mesh) => `<scene version="0.6.0">
  <sensor type="orthographic">
    <transform name="toWorld"><scale x="2" y="2"/><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/></film>
  </sensor>
  <integrator type="path"><integer name="maxDepth" value="2"/></integrator>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
  <shape type="obj"><string name="filename" value="${mesh}"/></shape>
  <shape type="cube"/>
</scene>`;

function writeScene(folder, mesh) {
  writeFileSync(join(folder, "room.xml"), scene(mesh));
  writeFileSync(join(folder, "wall.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
}

test("import: a folder whose job renders, and a line for what is not exact", async (t) => {
  const folder = temporaryFolder(t);
  writeScene(folder, "wall.obj");
  const imported = await run(folder, "import", "room.xml", "--out", "room");
  assert.equal(imported.code, 0, imported.err);
  assert.match(imported.out, /job\.json: 2 shapes, 0 lights, 1 cameras; 0 notes\n$/);
  const job = JSON.parse(readFileSync(join(folder, "room/job.json")));
  assert.equal(job.scene, "room/scene.glb");
  assert.deepEqual(job.environment, { file: "room/environment.exr" });
  writeFileSync(join(folder, "room/quick.json"), JSON.stringify({ ...job, budget: { iterations: 2 } }));
  const rendered = await run(folder, "render", "room/quick.json", "--out", "done");
  assert.equal(rendered.code, 0, rendered.err);
  assert.ok(existsSync(join(folder, "done/image.exr")));
});

test("import: a missing mesh is an error, or a line", async (t) => {
  const folder = temporaryFolder(t);
  writeScene(folder, "gone.obj");
  const refused = await run(folder, "import", "room.xml");
  assert.equal(refused.code, 3);
  assert.match(refused.err, /room\.xml:8: gone\.obj does not exist; --missing skip leaves such files out/);
  const skipped = await run(folder, "import", "room.xml", "--missing", "skip");
  assert.equal(skipped.code, 0, skipped.err);
  assert.match(skipped.out, /^room\.xml:8 +shape \(obj\) +left out +gone\.obj is missing$/m);
});

test("import: other endings and choices are refused", async (t) => {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, "a.blend"), "");
  const ending = await run(folder, "import", "a.blend");
  assert.equal(ending.code, 3);
  assert.match(ending.err, /ends in "\.blend"; allowed: \.xml \(Mitsuba\), \.pbrt/);
  assert.equal((await run(folder, "import", "a.blend", "--missing", "guess")).code, 2);
});
