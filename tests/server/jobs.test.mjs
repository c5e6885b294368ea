// A job's life over HTTP: posted, listed, done, and its files.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { folders, head, Service, until } from "./service.mjs";

test("a job is posted, stored, rendered and listed", async (t) => {
  const service = await Service.start(folders(t));
  assert.deepEqual(await service.json("/health"), { status: "ok" });
  assert.deepEqual(await service.json("/api/scenes"), { scenes: ["room/scene.glb"] });
  const empty = await service.json("/api/jobs");
  assert.deepEqual([empty.jobs, empty.total, empty.next], [[], 0, null]);

  const response = await service.postText(JSON.stringify({
    scene: "room/scene.glb", label: "gate one", integrator: { type: "path", max_depth: 3 },
  }));
  assert.equal(response.status, 201);
  const posted = await response.json();
  assert.equal(response.headers.get("location"), `/api/jobs/${posted.id}`);
  assert.equal(posted.job.integrator.max_depth, 3);
  assert.equal(posted.job.seed, 1, "defaults are filled in");
  assert.deepEqual(JSON.parse(fs.readFileSync(path.join(service.folder(posted.id), "job.json"))),
    posted.job);

  const running = await service.reaches(posted.id, "running");
  const entry = async () => (await service.json("/api/jobs")).jobs.find((j) => j.id === posted.id);
  const begun = await until(async () => {
    const found = await entry();
    return found.progress && found;
  }, "there is progress");
  assert.equal(begun.picture, false, "progress comes before the first picture");
  assert.equal(running.state.attempts, 1);
  assert.ok(running.state.created && running.state.started && !running.state.finished);
  service.open("one");
  const done = await service.reaches(posted.id, "done");
  assert.equal(done.progress.share, 1);
  assert.equal(done.state.error, "");
  assert.equal(done.state.exit_code, 0);
  const names = done.files.map((f) => f.name).sort();
  assert.deepEqual(names, ["curve.csv", "image.exr", "image.png", "job.json", "log.txt",
    "outcome.json", "progress.json", "report.json"]);
  assert.equal(done.files.find((f) => f.name === "image.exr").bytes, 100000);

  const second = await service.post("finish");
  await service.reaches(second, "done");
  const { jobs } = await service.json("/api/jobs");
  assert.deepEqual(jobs.map((j) => j.id), [second, posted.id], "newest first");
  const listed = jobs.find((j) => j.id === posted.id);
  assert.equal(listed.label, "gate one");
  assert.equal(listed.scene, "room/scene.glb");
  assert.equal(listed.integrator, "path");
  assert.equal(listed.state, "done");
  assert.equal(listed.progress.share, 1);
  assert.equal(listed.picture, true);
});

test("the schema is that of the job file", async (t) => {
  const service = await Service.start(folders(t));
  const schema = await service.json("/api/schema/job");
  assert.match(schema.$schema, /2020-12/);
  assert.ok(schema.properties.scene);
});

test("files have types, validators and byte ranges", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const address = `/api/jobs/${id}/files/image.exr`;
  const whole = "0123456789".repeat(10000);

  const first = await service.fetch(address);
  assert.equal(first.status, 200);
  assert.equal(first.headers.get("content-type"), "image/x-exr");
  assert.equal(first.headers.get("x-content-type-options"), "nosniff");
  assert.equal(await first.text(), whole);
  const etag = first.headers.get("etag");

  const again = await service.fetch(address, { headers: { "If-None-Match": etag } });
  assert.equal(again.status, 304);
  assert.equal(await again.text(), "");

  const ranged = async (range, more = {}) => {
    const r = await service.fetch(address, { headers: { Range: range, ...more } });
    return [r.status, r.headers.get("content-range"), await r.text()];
  };
  assert.deepEqual(await ranged("bytes=3-7"), [206, "bytes 3-7/100000", "34567"]);
  assert.deepEqual(await ranged("bytes=99998-"), [206, "bytes 99998-99999/100000", "89"]);
  assert.deepEqual(await ranged("bytes=-3"), [206, "bytes 99997-99999/100000", "789"]);
  assert.deepEqual(await ranged("bytes=99999-200000"), [206, "bytes 99999-99999/100000", "9"]);
  assert.deepEqual(await ranged("bytes=0-1,0-1"), [200, null, whole], "several ranges: the whole");
  assert.deepEqual(await ranged("bytes=1-2", { "If-Range": "\"old\"" }), [200, null, whole]);
  assert.deepEqual(await ranged("bytes=1-2", { "If-Range": etag }),
    [206, "bytes 1-2/100000", "12"]);
  const [status, range] = await ranged("bytes=100000-");
  assert.deepEqual([status, range], [416, "bytes */100000"]);

  const only = await service.fetch(address, { method: "HEAD" });
  assert.equal(only.status, 200);
  assert.equal(only.headers.get("content-length"), "100000");
  assert.equal(await only.text(), "");

  fs.appendFileSync(path.join(service.folder(id), "image.exr"), "x");
  const changed = await service.fetch(address, { headers: { "If-None-Match": etag } });
  assert.equal(changed.status, 200, "a changed file has another tag");
  assert.equal((await changed.text()).length, 100001);
});

test("only the listed files of a job are served, and no links", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("crash once");
  await service.reaches(id, "done");
  const folder = service.folder(id);
  const status = async (name) => (await service.fetch(`/api/jobs/${id}/files/${name}`)).status;
  assert.ok(fs.existsSync(path.join(folder, "checkpoint.bin")));
  assert.equal(await status("checkpoint.bin"), 404, "not for others");
  assert.equal(await status(".lock"), 404);
  assert.equal(await status("nothing.txt"), 404);

  fs.rmSync(path.join(folder, "curve.csv"));
  assert.equal(await status("curve.csv"), 404, "not there");
  fs.writeFileSync(path.join(service.places.root, "secret"), "secret");
  fs.symlinkSync(path.join(service.places.root, "secret"), path.join(folder, "curve.csv"));
  assert.equal(await status("curve.csv"), 404, "a link");
  const { files } = await service.json(`/api/jobs/${id}`);
  assert.ok(!files.some((f) => f.name === "curve.csv"));
  fs.rmSync(path.join(folder, "report.json"));
  fs.mkdirSync(path.join(folder, "report.json"));
  assert.equal(await status("report.json"), 404, "a folder");

  const elsewhere = path.join(service.places.root, "elsewhere");
  fs.renameSync(folder, elsewhere);
  fs.symlinkSync(elsewhere, folder);
  assert.equal(await status("image.png"), 404, "a job's folder behind a link");
});

test("no spelling of a path leaves a job's folder", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const jobs = path.dirname(service.folder(id));
  fs.mkdirSync(path.join(jobs, "copy"));
  for (const folder of [path.join(jobs, "copy"), jobs, path.dirname(jobs)]) {
    for (const name of ["job.json", "outcome.json"]) {
      fs.copyFileSync(path.join(service.folder(id), name), path.join(folder, name));
    }
  }
  const spellings = [
    "/api/jobs/copy", "/api/jobs/copy/files/job.json", "/api/jobs/../files/job.json",
    `/api/jobs/${id}/files/../job.json`, `/api/jobs/${id}/files/..%2fjob.json`,
    `/api/jobs/${id}/files/%2e%2e/job.json`, `/api/jobs/${id}/files/job.json%00.png`,
    `/api/jobs/${id}/files//etc/passwd`, `/api/jobs/${id}/files/job.json/`,
    `/api/jobs/${id}/files/..\\job.json`, `/api/jobs/../jobs/${id}`, "/api/jobs/..", "/api/jobs/.",
    `/api/jobs/${id}%00`, `/api/jobs/${id.toUpperCase()}`, "/api/jobs/%2e%2e%2f%2e%2e",
    "/../../../../etc/passwd", "/..%2f..%2fetc/passwd", "/vendor/../index.html", "//index.html",
    "/index.html%00", "/index.html/", "*", `http://localhost/api/jobs/${id}`,
  ];
  for (const spelling of spellings) {
    const answer = await service.raw(head(`GET ${spelling}`));
    assert.equal(answer.status, 404, spelling);
    assert.ok(!answer.body.includes("scene"), spelling);
  }
  assert.equal((await service.raw(head(`GET /api/jobs/${id}/files/job.json`))).status, 200);
  assert.equal((await service.raw(head(`GET /api/jobs/${id}/files/job.json?v=..`))).status, 200);
  assert.equal((await service.raw(head(`GET /api/jobs/${id}/files/job.json?w=..`))).status, 400);
});

test("the list comes by pages, and is searched by state and words", async (t) => {
  const service = await Service.start(folders(t));
  const ids = [];
  for (let i = 0; i < 7; i += 1) ids.push(await service.post(i % 2 ? `finish Odd ${i}` : `finish even ${i}`));
  for (const id of ids) await service.reaches(id, "done");
  await service.reaches(await service.post("fail"), "failed");
  const seen = [];
  let pages = 0;
  for (let next = ""; next !== null; pages += 1) {
    const page = await service.json(`/api/jobs?state=done&limit=3${next && `&cursor=${encodeURIComponent(next)}`}`);
    assert.equal(page.total, 7);
    assert.equal(page.counts.done, 7);
    assert.equal(page.counts.failed, 1);
    seen.push(...page.jobs.map((j) => j.id));
    next = page.next;
  }
  assert.equal(pages, 3);
  assert.deepEqual(seen, [...ids].reverse());
  const odd = await service.json("/api/jobs?label=oDD&limit=2");
  assert.deepEqual([odd.total, odd.jobs.length], [3, 2]);
  const rest = await service.json(`/api/jobs?label=oDD&limit=2&cursor=${encodeURIComponent(odd.next)}`);
  assert.deepEqual([rest.total, rest.jobs.length, rest.next], [3, 1, null]);
  assert.equal((await service.json("/api/jobs?state=done,failed&limit=1")).total, 8);
  for (const bad of ["state=dnoe", "limit=0", "limit=1001", "cursor=x", "page=2"]) {
    const answer = await service.fetch(`/api/jobs?${bad}`);
    assert.equal(answer.status, 400, bad);
    assert.ok((await answer.json()).detail.includes(bad.split("=")[0]), bad);
  }
});

test("the log is read from any place on", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("crash once");
  await service.reaches(id, "done");
  const whole = fs.readFileSync(path.join(service.folder(id), "log.txt"), "utf8");
  const first = await service.fetch(`/api/jobs/${id}/log`);
  assert.equal(await first.text(), whole);
  assert.equal(first.headers.get("next-offset"), String(whole.length));
  assert.equal(await (await service.fetch(`/api/jobs/${id}/log?offset=10`)).text(), whole.slice(10));
  assert.equal(await (await service.fetch(`/api/jobs/${id}/log?offset=${whole.length}`)).text(), "");
  assert.equal((await service.fetch(`/api/jobs/${id}/log?offset=${whole.length + 1}`)).status, 416);
});

test("a long log is read in parts", async (t) => {
  const service = await Service.start(folders(t));
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const whole = "0123456789abcdef".repeat(150_000);
  fs.writeFileSync(path.join(service.folder(id), "log.txt"), whole);
  let read = "";
  for (let part = 1; read.length < whole.length; part += 1) {
    const answer = await service.fetch(`/api/jobs/${id}/log?offset=${read.length}`);
    const text = await answer.text();
    assert.ok(text.length > 0 && text.length <= 1 << 20, `part ${part} has ${text.length} bytes`);
    read += text;
    assert.equal(answer.headers.get("next-offset"), String(read.length));
  }
  assert.equal(read, whole);
});

test("the cache: artefacts as `lacuna cache list` shows them, and references", async (t) => {
  const places = folders(t);
  const entries = fileURLToPath(new URL("../fuzz/corpus/cache_entry", import.meta.url));
  fs.cpSync(entries, path.join(places.data, "cache"), { recursive: true });
  fs.writeFileSync(path.join(places.data, `cache/${"0".repeat(32)}.artefact`), "no entry");
  fs.mkdirSync(path.join(places.data, "references/door"), { recursive: true });
  fs.writeFileSync(path.join(places.data, "references/door/image.exr"), "x".repeat(1000));
  const service = await Service.start(places);
  const cache = await service.json("/api/cache");
  assert.deepEqual(cache.entries.map((e) => [e.kind, e.name, e.bytes]), [
    ["reference", "door", 1000], ["artefact", "skeleton", 192], ["artefact", "voxels", 149],
    ["artefact", "numbers", 141], ["artefact", "?", 8]]);
  assert.equal(cache.bytes, 1490);
  assert.equal(cache.entries[1].key, "skeleton 3 {resolution=128} geometry:00ff");
  assert.equal(cache.entries[1].label, "door.glb");
  assert.match(cache.entries[4].refused, /not an entry/);
  for (const e of cache.entries) assert.match(e.used, /^\d{4}-\d\d-\d\dT.*Z$/);
});

test("every address describes itself", async (t) => {
  const service = await Service.start(folders(t));
  const { openapi, paths } = await service.json("/openapi.json");
  assert.match(openapi, /^3\.1/);
  for (const [target, methods] of Object.entries(paths)) {
    for (const [method, doc] of Object.entries(methods)) assert.ok(doc.summary, `${method} ${target}`);
  }
  assert.ok(paths["/api/jobs/{id}"].patch.requestBody);
  const { states, transitions } = await service.json("/api/states");
  assert.deepEqual(states.filter((s) => s.terminal).map((s) => s.name), ["done", "failed", "cancelled"]);
  assert.deepEqual(states.find((s) => s.name === "held").actions, ["cancel", "release", "priority"]);
  assert.ok(transitions.some((x) => x.from === "held" && x.to === "queued" && x.by === "person"));
  const metrics = await (await service.fetch("/metrics")).text();
  assert.match(metrics, /^lacuna_jobs\{state="queued"\} 0$/m);
  const cache = await service.json("/api/cache");
  assert.deepEqual(cache, { bytes: 0, entries: [] });
  const upload = await service.fetch("/api/scenes/a.glb", { method: "PUT", body: "x",
    headers: { "Content-Type": "model/gltf-binary" } });
  assert.equal(upload.status, 404, "off unless asked for");
});
