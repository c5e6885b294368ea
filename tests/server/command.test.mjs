// The command line.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { fakeRenderer, folders, runToEnd, Service, web } from "./service.mjs";

test("help and version", async () => {
  const help = await runToEnd(["--help"]);
  assert.equal(help.code, 0);
  for (const option of ["--port", "--bind", "--data", "--scenes", "--jobs", "--renderer", "--web",
    "--max-attempts", "--grace", "--memory-limit", "--nice", "--max-jobs", "--disk-floor",
    "--keep-jobs", "--keep-days", "--uploads", "--token-file", "--host", "--verbose"]) {
    assert.ok(help.out.includes(option), option);
  }
  const version = await runToEnd(["--version"]);
  assert.equal(version.code, 0);
  assert.match(version.out, /^lacuna-server \d+\.\d+\.\d+\n$/);
});

test("what cannot work is refused with a message", async (t) => {
  const places = folders(t);
  const base = ["--port", "0", "--data", places.data, "--scenes", places.scenes,
    "--renderer", fakeRenderer];
  const refused = async (args, message) => {
    const { code, out, err } = await runToEnd([...base, ...args]);
    assert.notEqual(code, 0, args.join(" "));
    assert.equal(out, "");
    assert.match(err, message);
  };
  await refused(["--bind", "0.0.0.0"], /other machines can reach 0\.0\.0\.0/);
  await refused(["--bind", "::"], /other machines/);
  await refused(["--bind", "example.com"], /not an address/);
  await refused(["--renderer", "/nowhere/lacuna"], /\/nowhere\/lacuna is not an executable program/);
  await refused(["--web", places.data], /index\.html/);
  await refused(["--scenes", "/nowhere"], /\/nowhere is not a folder of scenes/);
  await refused(["--port", "70000"], /70000/);
  await refused(["--jobs", "0"], /--jobs/);
  await refused(["--grace", "-1"], /--grace/);
  await refused(["--nice", "20"], /--nice/);
  await refused(["--nice", "-1"], /--nice/);
  await refused(["--memory-limit", "4X"], /--memory-limit.*"4X".*4G/);
  await refused(["--memory-limit", "-1"], /--memory-limit.*"-1"/);
  await refused(["--memory-limit", "1M"], /--memory-limit.*"1M".*256\.0 MiB/);
  await refused(["--nonsense"], /nonsense/);
  const file = path.join(places.root, "file");
  fs.writeFileSync(file, "");
  await refused(["--data", file], /file/);
});

test("a port that is taken is refused", async (t) => {
  const service = await Service.start(folders(t));
  const places = folders(t);
  const { code, err } = await runToEnd(["--port", `${service.port}`, "--data", places.data,
    "--scenes", places.scenes, "--renderer", fakeRenderer, "--web", web]);
  assert.equal(code, 1);
  assert.match(err, new RegExp(`${service.port}.*in use`));
});

test("several folders of scenes", async (t) => {
  const places = folders(t);
  const more = path.join(places.root, "more");
  fs.mkdirSync(more);
  fs.writeFileSync(path.join(more, "other.gltf"), "");
  const service = await Service.start(places, ["--scenes", more]);
  assert.deepEqual((await service.json("/api/scenes")).scenes, ["other.gltf", "room/scene.glb"]);
  const id = await service.post("environment", { scene: "other.gltf" });
  await service.reaches(id, "done");
  assert.equal((await service.json(`/api/jobs/${id}/files/report.json`)).scenes,
    `${places.scenes}:${more}`);
});
