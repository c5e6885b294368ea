// Figures of jobs, and the paths of a pixel, over HTTP: by the real renderer, and what is refused.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { lacuna, realFolders, startReal } from "./real_service.mjs";
import { folders, Service, until } from "./service.mjs";

const small = { scene: "cornell.glb", resolution: [32, 24], threads: 1, budget: { iterations: 8 }, reference: "auto",
  reference_iterations: 32 };

const post = (service, target, body) => service.fetch(target, body === undefined ? { method: "POST" }
  : { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });

async function refused(service, target, body) {
  const answer = await post(service, target, body);
  assert.match(answer.headers.get("content-type"), /problem\+json/);
  return { status: answer.status, ...await answer.json() };
}

async function render(service, job) {
  const { id } = await (await service.postText(JSON.stringify({ ...small, ...job }))).json();
  await service.reaches(id, "done");
  return id;
}

test("a figure of two jobs in each format, the same as at the shell; the paths of a pixel", async (t) => {
  const places = realFolders(t);
  const service = await startReal(places);
  const [first, second] = [await render(service, {}), await render(service, { integrator: "bdpt" })];
  const spec = { scenes: [{ name: "Cornell", crops: [[4, 4, 8, 6]], exposure: 0.5 }], metrics: ["relmse"],
    show: ["pictures", "table"],
    methods: [{ name: "Path", jobs: [first] }, { name: "BDPT", jobs: [second] }] };
  for (const [format, type, begin] of [["pdf", "application/pdf", "%PDF"], ["svg", "image/svg+xml", "<?xml"],
    ["png", "image/png", "\x89PNG"]]) {
    const answer = await post(service, `/api/figures?format=${format}`, spec);
    const bytes = Buffer.from(await answer.arrayBuffer());
    assert.equal(answer.status, 200, bytes.toString());
    assert.equal(answer.headers.get("content-type").split(";")[0], type);
    assert.ok(bytes.toString("latin1").startsWith(begin), format);
  }
  const file = path.join(places.root, "figure.json");
  fs.writeFileSync(file, JSON.stringify(spec));
  execFileSync(lacuna, ["figure", file, "-o", path.join(places.root, "figure.svg")],
    { env: { ...process.env, LACUNA_DATA: places.data }, stdio: "pipe" });
  assert.equal(await (await post(service, "/api/figures?format=svg", spec)).text(),
    fs.readFileSync(path.join(places.root, "figure.svg"), "utf8"));

  const traced = await post(service, `/api/jobs/${first}/trace?x=16&y=20&samples=8&brightest=3`);
  assert.equal(traced.status, 200);
  const paths = await traced.json();
  assert.deepEqual([paths.pixel, paths.samples, paths.seed, paths.paths.length], [[16, 20], 8, 1, 3]);
  assert.ok(paths.bounds[0].every((low, k) => low < paths.bounds[1][k]));
  const [eye, hit] = paths.paths[0].vertices;
  assert.ok(eye.position && hit.density > 0);

  const { paths: routes } = await service.json("/openapi.json");
  assert.ok(routes["/api/figures"].post.requestBody.content["application/json"].schema.properties.methods);
  assert.deepEqual(routes["/api/jobs/{id}/trace"].post.parameters.map((p) => p.name), ["id", "x", "y", "samples", "brightest"]);
  assert.deepEqual((await service.json("/api/schema/figure")).required, ["scenes", "methods"]);

  const told = async (target, body) => {
    const { status, detail } = await refused(service, target, body);
    return [status, detail];
  };
  const methods = (...jobs) => ({ ...spec, methods: [{ name: "a", jobs }] });
  for (const name of ["20200101-000000-nobody", `../jobs/${first}`, places.data, ""]) {
    const [status, detail] = await told("/api/figures", methods(first, name));
    assert.equal(status, 400);
    assert.equal(detail, `/methods/0/jobs/1: found "${name}": there is no such folder; allowed: the id of a job`);
  }
  for (const name of ["../sweeps", "20200101-000000-nobody"]) {
    assert.match((await told("/api/figures", { ...spec, sweep: name, methods: [{ name: "a" }] }))[1], /^\/sweep: .* the id of a sweep$/);
  }
  assert.match((await told("/api/figures", { ...spec, nothing: 1 }))[1], /^\/nothing: unknown key/);
  assert.match((await told("/api/figures?format=tex", spec))[1], /takes pdf, svg or png/);
  const outside = await told("/api/figures", { ...spec, scenes: [{ name: "a", crops: [[30, 0, 8, 6]] }] });
  assert.equal(outside[0], 400);
  assert.match(outside[1], /\/scenes\/0\/crops\/0: found \[30, 0, 8, 6\]; allowed: a rectangle inside the picture, 32 x 24/);

  assert.equal((await told(`/api/jobs/${first}/trace?x=32&y=0&samples=1`))[0], 400);
  assert.match((await told(`/api/jobs/${first}/trace?x=1&y=1&samples=9`))[1], /allowed: 1 to 8/);
  for (const query of ["x=1", "x=-1&y=0", "x=1&y=1&samples=0", "x=1&y=1&threads=64"]) {
    assert.equal((await told(`/api/jobs/${first}/trace?${query}`))[0], 400, query);
  }
  assert.equal((await told("/api/jobs/20200101-000000-nobody/trace?x=0&y=0"))[0], 404);
  const sppm = await render(service, { integrator: "sppm" });
  assert.match((await told(`/api/jobs/${sppm}/trace?x=1&y=1&samples=1`))[1], /found "sppm".*allowed: "path"/);
  assert.deepEqual(fs.readdirSync(path.join(places.data, "sweeps")), [], "nothing is left over");
});

test("two at a time, in limited time and memory; a stop ends them", async (t) => {
  const places = folders(t);
  const renderer = path.join(places.root, "slow");
  fs.writeFileSync(renderer, `#!/bin/sh\necho $$ >>${places.root}/started\nexec sleep 1000\n`, { mode: 0o755 });
  const service = await Service.start(places, ["--renderer", renderer]);
  const held = await (await service.postText(JSON.stringify({ scene: "room/scene.glb" }))).json();
  const trace = () => post(service, `/api/jobs/${held.id}/trace?x=0&y=0`);
  const started = () => (fs.existsSync(`${places.root}/started`)
    ? fs.readFileSync(`${places.root}/started`, "utf8").trim().split("\n").length : 0);
  const two = [trace(), trace()];
  await until(() => started() === 3, "the job and two traces run");
  const third = await trace();
  assert.equal(third.status, 503);
  assert.ok(Number(third.headers.get("retry-after")) > 0);
  assert.match((await third.json()).detail, /Two figures or traces/);
  assert.equal((await service.fetch("/health")).status, 200);
  const answers = Promise.allSettled(two);
  await service.stop();
  for (const { value } of await answers) assert.ok(value === undefined || value.status === 503);
});

test("what the program says of its failure is the answer", async (t) => {
  const places = folders(t);
  const renderer = path.join(places.root, "failing");
  fs.writeFileSync(renderer, "#!/bin/sh\n. ./how\n", { mode: 0o755 });
  const service = await Service.start(places, ["--renderer", renderer]);
  const { id } = await (await service.postText(JSON.stringify({ scene: "room/scene.glb" }))).json();
  for (const [how, status, detail] of [
    ["echo 'warning: x' >&2; echo 'lacuna: no such pixel' >&2; exit 2", 400, /^no such pixel$/],
    ["echo 'lacuna: no scene' >&2; exit 3", 409, /^no scene$/], ["echo 'lacuna: out of memory' >&2; exit 71", 503, /^out of memory$/],
    ["echo 'lacuna: the disk is full' >&2; exit 75", 503, /the disk is full/], ["exit 1", 500, /exit code 1/],
    ["kill -SEGV $$", 500, /signal 11/], ["exit 127", 503, /exit code 127/]]) {
    fs.writeFileSync(path.join(places.data, "how"), how);
    const told = await refused(service, `/api/jobs/${id}/trace?x=0&y=0`);
    assert.equal(told.status, status, how);
    assert.match(told.detail, detail);
  }
});
