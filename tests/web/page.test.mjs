// Every view of the page against the mock server.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { test } from "node:test";

import { frames, ready, screenshot } from "./browser.mjs";
import { curve, hostile, progress } from "./fixtures.mjs";
import { pageFile } from "./mock_server.mjs";
import { mock, open, origin, page } from "./stage.mjs";

const running = "20260131-101900-running";
const evil = "20260131-101700-hostile";
const shallow = "20260131-101500-shallow";
const cornell = "20260131-101400-cornell";

const views = {
  jobs: "/#/",
  job: `/#/job/${cornell}`,
  running: `/#/job/${running}`,
  choice: `/#/job/${shallow}`,
  failed: `/#/job/${evil}`,
  compare: `/#/compare?jobs=${cornell},${shallow},${running}`,
  new: "/#/new",
};

const text = (selector) => page.locator(selector).first().innerText();
const count = (selector) => page.locator(selector).count();
const attribute = (selector, name) => page.locator(selector).first().getAttribute(name);
const overflow = () => page.evaluate(() =>
  document.documentElement.scrollWidth - document.documentElement.clientWidth);

for (const [name, path] of Object.entries(views)) {
  test(`${name} loads without a console message, in light and dark, wide and narrow`, async () => {
    await open(path);
    await page.waitForFunction(() => document.readyState === "complete"
      && [...document.images].every((image) => image.complete || image.loading === "lazy"));
    assert.equal(await count("[role=alert] h1"), 0);
    assert.ok((await text("h1")).length > 0);
    await screenshot(page, `${name}-light`);
    await page.emulateMedia({ colorScheme: "dark" });
    await screenshot(page, `${name}-dark`);
    await page.setViewportSize({ width: 400, height: 800 });
    await frames(page);
    assert.equal(await overflow(), 0, "no sideways scrolling at 400 pixels");
    await screenshot(page, `${name}-narrow`);
    await page.setViewportSize({ width: 340, height: 700 });
    await frames(page);
    assert.equal(await overflow(), 0, "no sideways scrolling at 340 pixels");
    assert.deepEqual(page.troubles, []);
  });
}

test("what a first visit reads is under 60 kB, and all of the page under 200", async () => {
  const folder = new URL("../../web/", import.meta.url);
  const sizes = new Map([...readdirSync(folder), "job_tables.js"].map((name) => [name, pageFile(name).length]));
  const total = (names) => [...names].reduce((sum, name) => sum + sizes.get(name), 0);
  const read = new Set(["index.html", "style.css", "view_jobs.js"]);
  const follow = (name) => {
    for (const [, next] of String(pageFile(name)).matchAll(/^import [^;]*?"\.\/(\w+\.js)";$/gm)) {
      if (!read.has(next)) follow(next);
      read.add(next);
    }
  };
  for (const name of ["app.js", "view_jobs.js"]) follow(name);
  assert.ok(read.has("dom.js") && !read.has("viewer.js"), [...read].join());
  assert.ok(total(read) < 60_000, `${total(read)} bytes are read at first`);
  assert.ok(total(sizes.keys()) < 200_000, `${total(sizes.keys())} bytes in all`);
});

test("every view shows names as text", async () => {
  for (const job of mock.jobs) job.job = { ...job.job, label: hostile, scene: `${hostile}.glb` };
  await open("/");
  for (const [name, path] of Object.entries(views)) {
    await page.goto(origin + path);
    await ready(page);
    if (name !== "new") await page.waitForFunction((t) => document.querySelector("main").innerText.includes(t), hostile);
    assert.equal(await count("main img[src=x]"), 0);
    assert.equal(await page.evaluate(() => window.hacked), undefined);
  }
  assert.deepEqual(page.troubles, []);
});

test("a running job moves, gets its curve and picture, and ends", async () => {
  await open(views.running);
  assert.equal(await attribute(".plot", "data-points"), "3");
  mock.update(running, { progress: progress(20, 0.5, { error_metric: "est_rmse" }) });
  await page.waitForFunction(() => document.querySelector(".title progress").value === 0.5);
  mock.update(running, { files: { "curve.csv": curve({ rows: 6, cost: 0.7, level: 0.4 }) },
    state: { state: "done", phase: "", finished: "2026-01-31T10:20:00.000Z" } });
  await page.waitForSelector(".plot[data-points='6']");
  assert.equal(await text(".title .badge"), "done");
  assert.equal(await page.locator(".title progress").isVisible(), false);
  assert.equal(await page.getByRole("button", { name: "Cancel job" }).isVisible(), false);
  await page.waitForFunction(() => document.querySelector(".frame img").naturalWidth === 160);
  assert.equal([...mock.listeners].length, 0, "the page has stopped listening");
  assert.deepEqual(page.troubles, []);
});

test("a job shows its report with units, its files and its settings", async () => {
  await open(views.job);
  const report = await page.locator(".report").innerText();
  assert.match(report, /peak memory bytes\s+175\sMiB/);
  assert.match(report, /render\s+30\.0\ss/);
  assert.match(report, /rays per second\s+19\.9\sM\/s/);
  assert.match(report, /1 type\s+camera\s+1 share\s+0\.310/);
  assert.equal(await count(".files a"), 8);
  assert.match(await page.locator("article").innerText(), /512 × 512/);
  await page.getByText("Curve as a table").click();
  assert.equal(await count("details[open] tbody tr"), 11);
  await page.getByText("Log", { exact: true }).click();
  await page.getByText("loaded the scene in 41 ms").waitFor();
  assert.deepEqual(page.troubles, []);
});

test("a job of auto shows how its method was chosen", async () => {
  await open(views.choice);
  const choice = await page.locator(".candidates").innerText();
  assert.match(choice, /path, reuse 16\s+8\s+0\.200\ss\s+0\.00400\s+a larger error than that of others/);
  assert.match(choice, /metropolis, path_space\s+6\s+0\.200\ss\s+0\.00160\s+chosen/);
  assert.match(choice, /bdpt, skeleton\s+0\s+0\.100\ss\s+an iteration takes longer than its turn/);
  assert.equal(await count(".candidates g.curve"), 2);
  assert.doesNotMatch(await page.locator(".report").innerText(), /candidates/i);
  await screenshot(page, "choice");
});

test("a job says which machine it runs in, and follows when it moves", async () => {
  const facts = () => page.locator("article").innerText();
  await open(views.running);
  assert.doesNotMatch(await facts(), /Runs in/);
  for (const place of ["Slurm job 7 on node1", "Slurm job 8 waits: Resources"]) {
    mock.update(running, { state: { place } });
    await page.getByText(place).waitFor();
    assert.match(await facts(), new RegExp(`Runs in\\s+${place}`));
  }
});

test("an answer that was asked for before an event takes nothing of it back", async (t) => {
  const held = [];  // answers, as the service gave them
  const heldAnswer = async (n) => {
    while (held.length <= n) await page.waitForTimeout(10);
    return held[n];
  };
  const asked = `**/api/jobs/${running}`;
  await open(views.running);
  await page.route(asked, async (route) => {
    const response = await route.fetch();
    held.push(() => route.fulfill({ response }));
  });
  t.after(() => page.unroute(asked));
  mock.update(running, { state: { phase: "loading" } });
  const old = await heldAnswer(0);
  mock.update(running, { state: { place: "node1" }, progress: progress(8, 0.2) });
  await page.getByText("node1").waitFor();
  const facts = () => page.locator("article").innerText();
  assert.match(await facts(), /Iterations\s+8/);
  await old();
  const next = await heldAnswer(1);  // the page has shown the first one
  assert.match(await facts(), /Runs in\s+node1/);
  assert.match(await facts(), /Iterations\s+8/);
  await next();
});

test("a job shows where its time and rays went, and what was built, loaded and left out", async () => {
  await open(views.job);
  const effort = await page.locator(".effort").innerText();
  assert.match(effort, /Time: 42\.9\ss in total/);
  assert.match(effort, /render 30\.0\ss, 69\.9 %/);
  const threads = await page.locator(".threads").innerText();
  assert.match(threads, /Threads: 0\.530\ss with one thread at work, 1\.02\ss of waiting for others/);
  assert.match(threads, /photon grid\s+0\.400\ss\s+0\.900\ss\s+1\.10\ss\s+curve[^]*eye paths/);
  assert.match(effort, /shadow rays 512\s000\s000, 35\.7 %/);
  assert.match(effort, /built\s+skeleton \(1\.50\ss, 2\.00\sKiB disk\)\s+loaded\s+octree\s+left out\s+2 of 3 textures/);
  const widths = await page.locator(".stacked-bar").first().locator("span").evaluateAll(
    (all) => all.map((piece) => piece.getBoundingClientRect().width / piece.parentElement.clientWidth));
  assert.ok(Math.abs(widths[0] - 30.02 / 42.94) < 0.01, `${widths}`);
  assert.ok(Math.abs(widths.reduce((a, b) => a + b) - 1) < 0.01, `${widths}`);
});

test("the log is followed while the job runs, from its tail on, and only while it is open", async () => {
  const lines = (from, to) => Array.from({ length: to - from }, (_, i) => `line ${from + i} ä`).join("\n") + "\n";
  mock.update(running, { files: { "log.txt": lines(0, 10000) } });
  await open(views.running);
  assert.ok(!mock.requests.some((r) => r.includes("log.txt")));
  await page.getByText("Log", { exact: true }).click();
  const log = page.locator("pre[aria-label=Log]");
  await page.waitForFunction(() => document.querySelector("pre[aria-label=Log]").textContent.endsWith("line 9999 ä\n"));
  const start = await log.evaluate((pre) => pre.textContent.slice(0, 20));
  assert.match(start, /^line \d+ ä\nline/);
  assert.match(await page.locator("details[open] .note").innerText(), /^The last part of it, from .* on\. The whole log$/);
  assert.ok(await log.evaluate((pre) => pre.scrollTop > 0));
  mock.update(running, { files: { "log.txt": lines(0, 10003) }, progress: progress(8, 0.2) });
  await page.waitForFunction(() => document.querySelector("pre[aria-label=Log]").textContent
    .endsWith("line 9999 ä\nline 10000 ä\nline 10001 ä\nline 10002 ä\n"));
  assert.deepEqual(page.troubles, []);
});

test("a failed job says why, plainly", async () => {
  await open(views.failed);
  assert.equal(await text(".problem"), `scene ${hostile}.glb: no such file`);
  assert.match(await text(".warning"), /no light/);
  assert.equal(await text(".plot .note"), "No errors have been measured.");
});

test("the curve's switches change the plot and the address", async () => {
  await open(views.job);
  const figure = page.locator(".plot svg");
  assert.match(await figure.getAttribute("aria-label"), /^RMSE .* against render time/);
  await page.getByLabel("Error", { exact: true }).selectOption("est_rmse");
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  assert.match(await figure.getAttribute("aria-label"), /^estimated RMSE .* against iterations/);
  assert.ok(page.url().includes("y=est_rmse"));
  await page.reload();
  await ready(page);
  assert.match(await figure.getAttribute("aria-label"), /^estimated RMSE .* against iterations/);
  assert.deepEqual(page.troubles, []);
});

test("hollow points are explained where a reference's floor is reached, and only there", async () => {
  await open(views.job);
  const legend = () => page.locator(".plot svg").evaluate((svg) => svg.textContent.includes("hollow: at the reference's own noise"));
  assert.equal(await legend(), true);
  await page.getByLabel("Error", { exact: true }).selectOption("est_rmse");
  assert.equal(await legend(), false);
});

test("compare lays as many curves over one another as there are jobs", async () => {
  await open(views.compare);
  assert.equal(await attribute(".plot", "data-curves"), "3");
  const table = await page.locator("main section table").first().innerText();
  for (const name of ["Cornell box, 6 edges", "atrium.glb", "× the fastest"]) assert.ok(table.includes(name), name);
  assert.match(await text(".warning"), /differ in \/scene, \/resolution, \/reference/);
  assert.deepEqual(page.troubles, []);
});

/// The cells of the first table of a comparison, by rows.
const compared = () => page.locator("main section table tbody tr").evaluateAll((rows) =>
  rows.map((row) => [...row.children].map((cell) => cell.textContent)));

test("compare says how many times as long as the fastest each job takes to the same error", async () => {
  const times = { [cornell]: 100, [shallow]: 200 };
  for (const [id, time] of Object.entries(times)) {
    mock.find(id).files["curve.csv"] = `iteration,seconds,cpu_seconds,rmse\n1,1,1,1\n100,${time},${time},0.1\n`;
  }
  await open(`/#/compare?jobs=${cornell},${shallow}`);
  assert.deepEqual((await compared()).slice(0, 2).map((row) => row.slice(-2)),
    [["100\u202fs", "1.00×"], ["200\u202fs", "2.00×"]]);
});

test("compare tells jobs of equal names apart by the ends of their ids", async () => {
  const [one, other] = [mock.find(cornell), mock.find(shallow)];
  other.job = { ...one.job, seed: 2 };
  await open(views.compare);
  const names = (await compared()).map(([name]) => name);
  for (const id of [cornell, shallow]) {
    const ending = `Cornell box, 6 edges, path · bsdf (${id.split("-").pop()})`;
    assert.ok(names.includes(ending), `${names} without ${ending}`);
  }
  assert.ok(names.includes("atrium.glb, path · bsdf"), `${names}`);
});

test("compare shows pictures without layers side by side, and says why", async () => {
  for (const id of [cornell, shallow]) {
    delete mock.find(id).files["layers.json"];
  }
  await open(views.compare);
  await page.waitForFunction(() => document.querySelectorAll(".gallery img").length === 3);
  await page.getByText("No layers.json: image.png").first().waitFor();
  assert.deepEqual(page.troubles, []);
});

test("compare shows what it can where a job is missing", async () => {
  await open(`/#/compare?jobs=${cornell},nobody`);
  assert.equal(await attribute(".plot", "data-curves"), "1");
  assert.equal(await text(".problem"), "nobody: There is no job nobody.");
});

test("a job is posted, and problems name their places", async () => {
  await open(views.new);
  await page.fill("textarea", JSON.stringify({ scene: "nowhere.glb" }));
  await page.getByRole("button", { name: "Post the job" }).click();
  assert.match(await text(".errors li"), /^\/scene found "nowhere.glb", allowed: atrium.glb/);
  await screenshot(page, "new-problems");
  await page.fill("textarea", JSON.stringify({ scene: "cornell.glb", label: "mine" }));
  await page.getByRole("button", { name: "Post the job" }).click();
  await page.waitForSelector("article");
  assert.equal(await text("h1"), "mine");
  assert.deepEqual(page.troubles.filter((t) => !/status of 400/.test(t)), []);
});

test("the new-job view takes a scene, or another job, and leads to the schema", async () => {
  await open(views.new);
  await page.getByLabel("Scene").selectOption("door/scene.glb");
  assert.equal(JSON.parse(await page.inputValue("textarea")).scene, "door/scene.glb");
  assert.equal(await page.getByText("All keys and their allowed values").getAttribute("href"), "/api/schema/job");
  await page.goto(`${origin}/#/new?from=${shallow}`);
  await ready(page);
  await page.waitForFunction(() => JSON.parse(document.querySelector("textarea").value).seed === 2);
  assert.deepEqual(page.troubles, []);
});

test("unknown addresses and jobs say so", async () => {
  await open("/#/job/nobody");
  assert.equal(await text(".problem"), "There is no job nobody.");
  await page.goto(`${origin}/#/elsewhere`);
  await page.getByText("No such view").waitFor();
});

test("the keyboard reaches the jobs, their boxes and the skip link", async () => {
  await open(views.jobs);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the content");
  const seen = [];
  for (let i = 0; i < 13; i += 1) {
    await page.keyboard.press("Tab");
    seen.push(await page.evaluate(() => document.activeElement.getAttribute("href")
      ?? document.activeElement.type));
  }
  assert.ok(seen.includes("checkbox") && seen.includes(`#/job/${running}`), seen.join(" "));
});

test("? lists the keys, Esc closes them, and text fields keep their ?", async () => {
  await open(views.jobs);
  await page.fill("input[type=search]", "");
  await page.locator("input[type=search]").press("?");
  assert.equal(await count("dialog"), 0);
  await page.locator("main").press("?");
  assert.match(await text("dialog"), /exposure half a stop up, down/);
  await page.keyboard.press("Escape");
  await page.waitForSelector("dialog", { state: "detached" });
  await page.getByRole("button", { name: "?" }).click();
  await page.setViewportSize({ width: 400, height: 800 });
  await screenshot(page, "keys-narrow");
  await page.getByRole("button", { name: "Close" }).click();
  await page.waitForSelector("dialog", { state: "detached" });
});
