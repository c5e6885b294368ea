// Requests that are refused: what is answered, and that nothing is left behind.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { folders, head, Service } from "./service.mjs";

const good = JSON.stringify({ scene: "room/scene.glb", label: "finish" });

async function problem(response, status) {
  const text = await response.text();
  assert.equal(response.status, status, text);
  assert.equal(response.headers.get("content-type"), "application/problem+json");
  const json = JSON.parse(text);
  assert.equal(json.status, status);
  for (const key of ["type", "title", "detail", "instance"]) {
    assert.equal(typeof json[key], "string", key);
  }
  return json;
}

async function noJobs(service) {
  assert.deepEqual(await service.json("/api/jobs"), { jobs: [] });
  assert.deepEqual(fs.readdirSync(path.join(service.places.data, "jobs")), []);
}

test("every fault of a job is named with its place, and no job is made", async (t) => {
  const service = await Service.start(folders(t));
  const pointers = async (job) => {
    const text = typeof job === "string" ? job : JSON.stringify(job);
    const json = await problem(await service.postText(text), 400);
    assert.equal(json.instance, "/api/jobs");
    assert.ok(json.errors.every((e) => e.message.length > 0));
    return json.errors.map((e) => e.pointer).sort();
  };
  const scene = "room/scene.glb";
  assert.deepEqual(await pointers({ scene, sead: 1 }), ["/sead"]);
  assert.deepEqual(await pointers({ scene, seed: -1, resolution: [0, 5] }), ["/resolution/0", "/seed"]);
  assert.deepEqual(await pointers({ scene, integrator: { type: "path", max_depth: "x" } }),
    ["/integrator/max_depth"]);
  assert.deepEqual(await pointers("{"), [""]);
  assert.deepEqual(await pointers("\xff\xfe"), [""]);
  await pointers("[".repeat(100000));
  await pointers("");
  for (const name of ["nothing.glb", "../scenes/room/scene.glb", "/etc/passwd", "room", "room/",
    "room/../room/scene.glb", "room\\scene.glb", "room/scene.glb\u0000"]) {
    assert.deepEqual(await pointers({ scene: name }), ["/scene"], name);
  }
  fs.symlinkSync("scene.glb", path.join(service.places.scenes, "room/link.glb"));
  assert.deepEqual(await pointers({ scene: "room/link.glb" }), ["/scene"], "a link");
  assert.deepEqual(await pointers({ scene, environment: { file: "sky.exr" } }),
    ["/environment/file"]);
  await noJobs(service);
});

test("a body must be JSON, plain, and not too large", async (t) => {
  const service = await Service.start(folders(t));
  for (const type of ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=a", "application/jsonp"]) {
    await problem(await service.postText(good, { "Content-Type": type }), 415);
  }
  assert.equal((await service.raw(head("POST /api/jobs", { "Content-Length": "2" }) + "{}")).status, 415);
  const zipped = { "Content-Type": "application/json", "Content-Encoding": "gzip" };
  await problem(await service.postText(gzipSync(good), zipped), 415);

  const large = JSON.stringify({ scene: "x".repeat(2 << 20) });
  await problem(await service.postText(large), 413);
  async function* chunks() {
    for (let i = 0; i < 64; i += 1) yield Buffer.alloc(64 * 1024, " ");
  }
  const chunked = await service.fetch("/api/jobs", {
    method: "POST", headers: { "Content-Type": "application/json" }, body: chunks(), duplex: "half",
  });
  await problem(chunked, 413);
  await noJobs(service);

  async function* fits() {
    for (const c of good) yield Buffer.from(c);
  }
  const small = await service.fetch("/api/jobs", {
    method: "POST", headers: { "Content-Type": "Application/JSON; charset=utf-8" }, body: fits(), duplex: "half",
  });
  assert.equal(small.status, 201, "chunks are fine as such");
});

test("the framing of a body must be clear", async (t) => {
  const service = await Service.start(folders(t));
  const json = { "Content-Type": "application/json" };
  const refused = [
    [{ ...json, "Content-Length": "-1" }, good],
    [{ ...json, "Content-Length": "1e3" }, good],
    [{ ...json, "Content-Length": "99999999999999999999999" }, good],
    [{ ...json, "Content-Length": `${good.length}`, "Transfer-Encoding": "chunked" }, good],
    [{ ...json, "Transfer-Encoding": "gzip, chunked" }, good],
    [{ ...json, "Transfer-Encoding": "chunked" }, "zz\r\nhello\r\n0\r\n\r\n"],
    [{ ...json, "Content-Length": "5", "content-length": "6" }, good],
  ];
  for (const [headers, body] of refused) {
    assert.equal((await service.raw(head("POST /api/jobs", headers) + body)).status, 400,
      JSON.stringify(headers));
  }
  // What follows a refused body is never taken for another request.
  const hidden = head("POST /api/jobs", { ...json, "Content-Length": `${good.length}` }) + good;
  const smuggled = await service.raw(
    head("POST /api/nothing", { "Content-Length": "0" }) + hidden);
  assert.equal(smuggled.status, 404);
  assert.ok(!smuggled.body.includes("HTTP/1.1"), "one answer a connection");
  assert.match(smuggled.head, /^Connection: close\r?$/m);
  await noJobs(service);
});

test("addresses that lead nowhere, and methods that do not fit", async (t) => {
  const service = await Service.start(folders(t));
  for (const address of ["/api", "/api/", "/api/jobs/", "/api/job", "/health/", "/nothing.html",
    "/api/jobs/20260101-000000-abcdef", "/api/jobs/20260101-000000-abcdef/events",
    "/api/jobs/20260101-000000-abcdef/files/job.json", "/api/jobs/x"]) {
    const json = await problem(await service.fetch(address), 404);
    assert.equal(json.instance, address);
  }
  await problem(await service.cancel("20260101-000000-abcdef"), 404);

  const allow = async (method, address) => {
    const response = await service.fetch(address, { method });
    await problem(response, 405);
    return response.headers.get("allow");
  };
  assert.equal(await allow("DELETE", "/api/jobs"), "GET, HEAD, POST");
  assert.equal(await allow("PUT", "/health"), "GET, HEAD");
  assert.equal(await allow("POST", "/api/scenes"), "GET, HEAD");
  assert.equal(await allow("OPTIONS", "/api/jobs"), "GET, HEAD, POST");
  assert.equal(await allow("GET", "/api/jobs/20260101-000000-abcdef/cancel"), "POST");
});

test("malformed requests get an answer or none, never a crash", async (t) => {
  const service = await Service.start(folders(t));
  const status = async (text) => (await service.raw(text)).status;
  assert.equal(await status("GARBAGE\r\n\r\n"), 400);
  assert.equal(await status("GET /health HTTP/3.0\r\nHost: localhost\r\n\r\n"), 400);
  assert.equal(await status(head("BREW /health")), 400);
  assert.equal(await status(head(`GET /${"a".repeat(2000)}`)), 414);
  assert.equal(await status(head(`GET /${"a".repeat(20000)}`)), 414);
  assert.equal(await status(head("GET /health", { Long: "a".repeat(20000) })), 400);
  assert.equal(await status(head("GET /health", { Range: "bytes=nonsense" })), 416);
  assert.equal(await status(head("GET /health", { Range: `bytes=${"-,".repeat(4000)}-` })), 200);
  assert.equal(await status(head("GET /health", { Range: `bytes=${"9".repeat(8000)}-` })), 416);
  await service.raw(`${head("GET /health").slice(0, -2)}${"A: b\r\n".repeat(100000)}\r\n`);
  await service.raw("\0".repeat(100000));
  await service.raw("\r\n".repeat(1000));
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("other sites can neither read nor write", async (t) => {
  const service = await Service.start(folders(t));
  const status = async (line, headers) => (await service.raw(head(line, headers))).status;
  for (const host of ["evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "localhost:",
    "localhost:80x", "192.168.0.1", "localhost@evil.example", "evil.example:8017"]) {
    assert.equal(await status("GET /api/jobs", { Host: host }), 403, host);
    assert.equal(await status("GET /", { Host: host }), 403, host);
  }
  for (const host of ["localhost", "localhost:8017", "127.0.0.1:1", "[::1]:8017", "[::1]"]) {
    assert.equal(await status("GET /api/jobs", { Host: host }), 200, host);
  }
  assert.equal(await status("GET /health", { Host: "" }), 400);
  assert.equal((await service.raw("GET /health HTTP/1.1\r\n\r\n")).status, 400, "no Host");
  assert.equal((await service.raw(
    "GET /health HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n")).status, 400, "two");

  const post = (origin) => service.raw(head("POST /api/jobs", {
    Host: "localhost:8017", Origin: origin, "Content-Type": "application/json",
    "Content-Length": `${good.length}`,
  }) + good);
  for (const origin of ["http://evil.example", "null", "http://localhost:8018", "https://localhost:8017"]) {
    assert.equal((await post(origin)).status, 403, origin);
  }
  await noJobs(service);
  assert.equal((await post("http://localhost:8017")).status, 201);
});
