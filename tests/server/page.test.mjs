// The page's files, and the headers that go with everything.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { folders, Service, web } from "./service.mjs";

test("the page is served", async (t) => {
  const service = await Service.start(folders(t));
  const index = await service.fetch("/");
  assert.equal(index.status, 200);
  assert.equal(index.headers.get("content-type"), "text/html; charset=utf-8");
  assert.equal(await index.text(), fs.readFileSync(path.join(web, "index.html"), "utf8"));
  for (const [name, type] of [["app.js", "text/javascript"], ["style.css", "text/css"]]) {
    const response = await service.fetch(`/${name}`);
    assert.equal(response.status, 200, name);
    assert.ok(response.headers.get("content-type").startsWith(type), name);
    assert.ok((await response.text()).length > 0);
  }
  const again = await service.fetch("/app.js", {
    headers: { "If-None-Match": (await service.fetch("/app.js")).headers.get("etag") },
  });
  assert.equal(again.status, 304);
});

test("every answer carries the headers that confine the page", async (t) => {
  const service = await Service.start(folders(t));
  for (const address of ["/", "/health", "/api/jobs", "/nothing", "/app.js"]) {
    const { headers } = await service.fetch(address);
    const policy = headers.get("content-security-policy");
    for (const part of ["default-src 'self'", "img-src 'self' blob: data:", "object-src 'none'",
      "frame-ancestors 'none'", "base-uri 'none'"]) {
      assert.ok(policy.includes(part), `${address}: ${part}`);
    }
    assert.equal(headers.get("x-content-type-options"), "nosniff");
    assert.equal(headers.get("referrer-policy"), "no-referrer");
    assert.equal(headers.get("access-control-allow-origin"), null);
  }
});

test("only regular web files that were there at the start are served", async (t) => {
  const places = folders(t);
  const folder = path.join(places.root, "page");
  fs.mkdirSync(path.join(folder, "inner"), { recursive: true });
  const put = (name, text = "text") => fs.writeFileSync(path.join(folder, name), text);
  put("index.html");
  put("notes.txt");
  put("inner/deep.js");
  put("later-link.js");
  fs.symlinkSync("/etc/passwd", path.join(folder, "link.js"));
  const service = await Service.start(places, ["--web", folder]);
  put("new.js");
  fs.rmSync(path.join(folder, "later-link.js"));
  fs.symlinkSync("/etc/passwd", path.join(folder, "later-link.js"));
  for (const name of ["notes.txt", "inner/deep.js", "link.js", "new.js", "later-link.js", "inner"]) {
    assert.equal((await service.fetch(`/${name}`)).status, 404, name);
  }
  put("index.html", "changed");
  assert.equal(await (await service.fetch("/")).text(), "changed", "content is read when it is asked for");
});
