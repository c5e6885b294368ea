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
  assert.deepEqual((await service.json("/api/jobs")).jobs, []);
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
  // A client must not run programs on this machine.
  const command = { type: "foreign", name: "x", command: ["touch", "/tmp/x"] };
  assert.deepEqual(await pointers({ scene, integrator: command }), ["/integrator/command"]);
  const sweep = { job: { scene }, axes: { "/integrator": ["path", command] } };
  const refused = await problem(await service.postSweepText(JSON.stringify(sweep)), 400);
  assert.deepEqual(refused.errors.map((e) => e.pointer), ["/axes/~1integrator/1/command"]);
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
  // What follows a refused body is never taken for another request: by content, as a page of another
  // site can send it.
  const hidden = `${" ".repeat(5000)}${head("POST /api/jobs", { ...json, "Content-Length": `${good.length}` })}${good}`;
  for (const line of ["POST /api/jobs", "POST /api/nothing", `POST /${"a".repeat(9000)}`]) {
    const refusal = await service.raw(head(line, { Connection: "keep-alive", Origin: "http://evil.example",
      "Content-Type": "text/plain", "Content-Length": `${hidden.length}` }) + hidden);
    assert.ok([403, 404, 414].includes(refusal.status));
    assert.match(refusal.head, /^Connection: close\r?$/m);
  }
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
  assert.equal(await status(head("TRACE /health")), 501);
  assert.equal(await status(head(`GET /${"a".repeat(2000)}`)), 414);
  assert.equal(await status(head(`GET /${"a".repeat(20000)}`)), 414);
  assert.equal(await status(head("GET /health", { Long: "a".repeat(20000) })), 400);
  assert.equal(await status(head("GET /health", { Range: "bytes=nonsense" })), 416);
  assert.equal(await status(head("GET /health", { Range: `bytes=${"-,".repeat(4000)}-` })), 200);
  assert.equal(await status(head("GET /health", { Range: `bytes=${"9".repeat(8000)}-` })), 416);
  await service.raw("\r\n".repeat(1000));
  assert.deepEqual(await service.json("/health"), { status: "ok" });
});

test("what leaves a doubt about who is asked, or where a request ends, is refused", async (t) => {
  const service = await Service.start(folders(t));
  const start = "GET /health HTTP/1.1\r\nHost: localhost\r\n";
  const refused = {
    "a tab": "GET\t/health\tHTTP/1.1\r\nHost: localhost\r\n\r\n",
    "no version": "GET /health\r\nHost: localhost\r\n\r\n",
    "a second question mark": "GET /health?a=1?b=2 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "two lengths that agree": `${start}Content-Length: 3\r\nContent-Length: 3\r\n\r\nabc`,
    "a list of lengths": `${start}Content-Length: 3, 3\r\n\r\nabc`,
    "length and chunks": `${start}Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n`,
    "two encodings": `${start}Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n\r\n0\r\n\r\n`,
    "two hosts": `${start}Host: localhost\r\n\r\n`,
  };
  for (const [what, text] of Object.entries(refused)) {
    const answer = await service.raw(text);
    assert.equal(answer.status, 400, what);
    assert.match(answer.head, /application\/problem\+json/, what);
  }
  const chunks = { "Content-Type": "application/json", "Transfer-Encoding": "chunked" };
  const chunked = async (body) => (await service.raw(head("POST /api/jobs", chunks) + body)).status;
  assert.equal(await chunked("zz\r\nhello\r\n0\r\n\r\n"), 400);
  await noJobs(service);
  assert.equal(await chunked(`${good.length.toString(16)};name=value\r\n${good}\r\n0\r\n\r\n`), 201);
});

test("HTTP/1.0, and HEAD", async (t) => {
  const service = await Service.start(folders(t));
  const old = await service.raw("GET /health HTTP/1.0\r\nHost: localhost\r\n\r\n");
  assert.equal(old.status, 200);
  assert.deepEqual(JSON.parse(old.body), { status: "ok" });
  const id = await service.post("finish");
  await service.reaches(id, "done");
  const events = await service.raw(`GET /api/jobs/${id}/events HTTP/1.0\r\nHost: localhost\r\n\r\n`);
  assert.match(events.body, /^id: \S+\nevent: /, "HTTP/1.0 knows no chunks");
  const none = await service.raw(head("HEAD /health"));
  assert.equal(none.status, 200);
  assert.match(none.head, /^Content-Length: [1-9]/m);
  assert.equal(none.body, "");
});

test("a query must be well formed, and its parameters known", async (t) => {
  const service = await Service.start(folders(t));
  const detail = async (query) => (await problem(await service.fetch(`/api/scenes?${query}`), 400)).detail;
  assert.match(await detail("lmit=3"), /unknown query parameter "lmit"; known: none/);
  assert.match(await detail("a=1&a=2"), /"a" is repeated/);
  assert.match(await detail("a=1&%61=2"), /"a" is repeated/);
  for (const bad of ["a=%", "a=%4", "a=%zz", "a=%00", "a=%0a", "a=%7f", "a=%c2%85", "a=%ff",
    "a=%c0%80", "a=%ed%a0%80", "%00=1"]) {
    assert.match(await detail(bad), /two hexadecimal digits|invalid UTF-8/, bad);
  }
  assert.match(await detail("=1"), /without a name/);
  assert.match(await detail("a=1&a=1"), /is repeated/);
  assert.match(await detail("a=b=c"), /second "="/);
  assert.equal((await service.raw(head("GET /api/scenes?"))).status, 200);
  assert.equal((await service.raw(head(`GET /api/scenes?a=${"x".repeat(1100)}`))).status, 414);
});

test("what the HTTP library would decode, pack or take apart in answers and bodies reaches nobody", async (t) => {
  const service = await Service.start(folders(t), ["--uploads"]);
  const status = async (line, headers) => (await service.raw(head(line, headers))).status;
  assert.equal(await status("GET /%68ealth"), 404, "an escape in a path");
  const packed = await service.raw(head("GET /api/states", { "Accept-Encoding": "gzip, br" }));
  assert.ok(!/^content-encoding/im.test(packed.head) && JSON.parse(packed.body));
  const ranged = await service.raw(head("GET /api/states", { Range: "bytes=0-3" }));
  assert.equal(ranged.status, 200, "a range is of a file only");
  const parts = { "Content-Type": "multipart/form-data; boundary=a", "Content-Length": "10" };
  assert.equal((await service.raw(`${head("PUT /api/scenes/a.glb", parts)}0123456789`)).status, 415);
});

test("the type of an upload is that of its name", async (t) => {
  const service = await Service.start(folders(t), ["--uploads"]);
  for (const [name, wrong, right] of [["a.glb", "application/zip", "model/gltf-binary"],
    ["a.zip", "model/gltf-binary", "application/zip"]]) {
    const put = (type) => service.fetch(`/api/scenes/${name}`, { method: "PUT", body: "x", headers: { "Content-Type": type } });
    assert.ok((await problem(await put(wrong), 415)).detail.endsWith(`${right}.`));
    await problem(await put(right), 422);
  }
});

test("an upload under a name that is not allowed is told what is", async (t) => {
  const service = await Service.start(folders(t), ["--uploads"]);
  const put = (name) => service.fetch(`/api/scenes/${name}`, { method: "PUT", body: "glTF",
    headers: { "Content-Type": "model/gltf-binary" } });
  for (const name of ["my room.glb", "k\u00fcche.glb", "\u5bb6.glb", "a+b.glb", "%FF.glb", "%00.glb", "%zz.glb", "a.GLB", "a.gltf"]) {
    const { detail } = await problem(await put(name), 400);
    assert.match(detail, /letter or digit.*"\.glb"/, name);
    assert.ok(detail.includes(new URL(name, "http://a/").pathname.slice(1)), detail);
  }
  await problem(await put("a%2Fb.glb"), 404);
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
  for (const origin of ["http://evil.example", "null", "http://localhost:8018", "https://localhost", "http://localhost:8017/", "localhost:8017"]) {
    assert.equal((await post(origin)).status, 403, origin);
  }
  await noJobs(service);
  assert.equal((await post("http://localhost:8017")).status, 201);
  assert.equal((await post("https://localhost:8017")).status, 201, "a TLS proxy in front");
});
