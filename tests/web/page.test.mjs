// Every view of the page against the mock server.
import assert from "node:assert/strict";
import { test } from "node:test";

import { ready, screenshot } from "./browser.mjs";
import { curve, hostile, progress } from "./fixtures.mjs";
import { Mock } from "./mock_server.mjs";
import { mock, open, origin, page } from "./stage.mjs";

const running = "20260131-101900-running";
const waiting = "20260131-101800-waiting";
const evil = "20260131-101700-hostile";
const shallow = "20260131-101500-shallow";
const cornell = "20260131-101400-cornell";

const views = {
  jobs: "/#/",
  job: `/#/job/${cornell}`,
  running: `/#/job/${running}`,
  failed: `/#/job/${evil}`,
  compare: `/#/compare?jobs=${cornell},${shallow},${running}`,
  new: "/#/new",
};

/// How many pictures a view has in the end.
const pictures = { "#/": 3, [views.running.slice(1)]: 1, [views.compare.slice(1)]: 1 };

const text = (selector) => page.locator(selector).first().innerText();
const count = (selector) => page.locator(selector).count();
const attribute = (selector, name) => page.locator(selector).first().getAttribute(name);
/// Waits for all pictures that the view asks for.
const settled = () => page.waitForFunction((n) => document.querySelectorAll("main img:not([hidden])").length >= n
  && [...document.images].every((image) => image.complete), pictures[new URL(page.url()).hash] ?? 0);

for (const [name, path] of Object.entries(views)) {
  for (const colorScheme of ["light", "dark"]) {
    test(`${name} loads in ${colorScheme} without a console message`, async () => {
      await open(path, { colorScheme });
      await settled();
      assert.equal(await count("[role=alert] h1"), 0);
      assert.ok((await text("h1")).length > 0);
      await screenshot(page, `${name}-${colorScheme}`);
      assert.deepEqual(page.troubles, []);
    });
  }

  test(`${name} needs no sideways scrolling in a narrow window`, async () => {
    await open(path, { viewport: { width: 360, height: 740 } });
    const [inner, outer] = await page.evaluate(() => [
      document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.ok(inner <= outer, `${inner} pixels of content in a window of ${outer}`);
    await screenshot(page, `${name}-narrow`);
  });

  test(`${name} shows names as text`, async () => {
    for (const job of mock.jobs) job.job = { ...job.job, label: hostile, scene: `${hostile}.glb` };
    await open(path);
    if (name !== "new") assert.ok((await page.locator("main").innerText()).includes(hostile));
    assert.equal(await count("main img[src=x]"), 0);
    assert.equal(await page.evaluate(() => window.hacked), undefined);
    assert.deepEqual(page.troubles, []);
  });
}

test("the list shows every job, newest first, with pictures only where there are any", async () => {
  await open(views.jobs);
  const ids = await page.locator("tr[data-job]").evaluateAll((rows) => rows.map((r) => r.dataset.job));
  assert.deepEqual(ids, mock.jobs.map((job) => job.id));
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length === 3);
  assert.match(await text(`tr[data-job="${running}"] .progress`), /^10 %, 27 s left$/);
  assert.equal(await text(`tr[data-job="${cornell}"] .error`), "rmse 0.0138");
  assert.equal(await text(`tr[data-job="${evil}"] .badge`), "failed");
});

test("the list follows the jobs", async () => {
  await open(views.jobs);
  const bar = page.locator(`tr[data-job="${running}"] progress`);
  assert.equal(await bar.evaluate((b) => b.value), 0.1);
  mock.update(running, { progress: progress(20, 0.5) });
  await page.waitForFunction((id) => document.querySelector(`tr[data-job="${id}"] progress`).value === 0.5,
    running);
  mock.jobs.splice(1, 1);
  await page.waitForSelector(`tr[data-job="${waiting}"]`, { state: "detached" });
  assert.deepEqual(page.troubles, []);
});

test("the filter keeps its jobs and goes into the address", async () => {
  await open(views.jobs);
  await page.fill("input[type=search]", "cornell DONE");
  assert.equal(await count("tr[data-job]"), 2);
  assert.equal(await text("main > .tools output"), "2 of 6");
  assert.ok(page.url().endsWith("#/?filter=cornell+DONE"));
  await page.reload();
  await ready(page);
  assert.equal(await count("tr[data-job]"), 2);
});

test("the list is narrowed to a state, which goes into the address", async () => {
  await open(views.jobs);
  const state = page.getByLabel("State", { exact: true });
  assert.ok((await state.innerText()).includes("done (2)"));
  await state.selectOption("failed");
  assert.equal(await count("tr[data-job]"), 1);
  assert.ok(page.url().endsWith("#/?state=failed"));
  await page.fill("input[type=search]", "nothing like it");
  assert.equal(await text("main > .tools output"), "0 of 6");
  await page.goto(`${origin}/#/?state=done&filter=without`);
  await page.waitForFunction(() => document.querySelectorAll("tr[data-job]").length === 1);
});

test("ten thousand jobs are listed a page at a time, without a pause", async () => {
  const [like] = mock.jobs.slice(-1);
  mock.jobs = Array.from({ length: 10000 }, (_, i) => ({ ...like, id: `20260131-101400-${10000 + i}`,
    job: { ...like.job, label: `job ${i}` } }));
  await open("/#/?page=2");
  assert.equal(await count("tr[data-job]"), 100);
  assert.equal(await text(".pager output"), "101–200 of 10000");
  await page.getByRole("button", { name: "Next page" }).click();
  assert.equal(await text("tr[data-job] .name a"), "job 200");
  assert.ok(page.url().endsWith("#/?page=3"));
  const took = await page.evaluate(() => {
    const filter = document.querySelector("input[type=search]");
    filter.value = "job 77";
    const began = performance.now();
    filter.dispatchEvent(new Event("input"));
    document.body.getBoundingClientRect();
    return performance.now() - began;
  });
  assert.equal(await text("main > .tools output"), "280 of 10000");
  assert.ok(took < 500, `${took} ms to filter`);
  console.log(`# filtering 10,000 jobs: ${took.toFixed(0)} ms`);
  const asked = mock.requests.filter((r) => /GET \/api\/jobs\/[^/]+$/.test(r)).length;
  assert.ok(asked < 100, `${asked} jobs asked for their thumbnails`);
  await screenshot(page, "jobs-many");
  assert.deepEqual(page.troubles, []);
});

test("jobs chosen in the list are compared", async () => {
  await open(views.jobs);
  const compare = page.getByRole("button", { name: /^Compare/ });
  assert.equal(await compare.isDisabled(), true);
  for (const id of [cornell, shallow]) await page.check(`tr[data-job="${id}"] input`);
  await compare.click();
  await page.waitForSelector(".plot canvas[data-curves='2']");
  assert.ok(page.url().endsWith(`#/compare?jobs=${cornell},${shallow}`));
});

test("an empty list says how to post the first job", async () => {
  mock.jobs = [];
  await open("/");
  assert.match(await text(".empty pre"), new RegExp(`^curl .*${origin}/api/jobs`));
  await screenshot(page, "empty");
  assert.deepEqual(page.troubles, []);
});

test("a running job moves, gets its curve and picture, and ends", async () => {
  await open(views.running);
  assert.equal(await attribute(".plot canvas", "data-points"), "3");
  mock.update(running, { progress: progress(20, 0.5, { error_metric: "est_rmse" }) });
  await page.waitForFunction(() => document.querySelector(".title progress").value === 0.5);
  mock.update(running, { files: { "curve.csv": curve({ rows: 6, cost: 0.7, level: 0.4 }) },
    state: { state: "done", phase: "", finished: "2026-01-31T10:20:00.000Z" } });
  await page.waitForSelector(".plot canvas[data-points='6']");
  assert.equal(await text(".title .badge"), "done");
  assert.equal(await page.locator(".title progress").isVisible(), false);
  assert.equal(await page.getByRole("button", { name: "Cancel job" }).isVisible(), false);
  await page.waitForFunction(() => document.querySelector(".frame img").naturalWidth === 640);
  assert.equal(mock.listeners.size, 0, "the page has stopped listening");
  assert.deepEqual(page.troubles, []);
});

test("a job is cancelled only after a question", async () => {
  await open(views.running);
  const cancel = page.getByRole("button", { name: "Cancel job" });
  page.once("dialog", (dialog) => dialog.dismiss());
  await cancel.click();
  assert.equal(mock.find(running).state.state, "running");
  page.once("dialog", (dialog) => dialog.accept());
  await cancel.click();
  await page.waitForSelector("article[data-state=cancelled]");
  assert.equal(mock.find(running).state.state, "cancelled");
  assert.deepEqual(page.troubles, []);
});

test("a job shows its report with units, its files and its settings", async () => {
  await open(views.job);
  const report = await page.locator(".report").innerText();
  assert.match(report, /peak memory bytes\s+175\sMiB/);
  assert.match(report, /render\s+30\.0\ss/);
  assert.match(report, /rays per second\s+19\.9\sM\/s/);
  assert.match(report, /loaded\s+octree/);
  assert.match(report, /type\s+share\s+1\s+camera\s+0\.310/);
  assert.equal(await count(".files a"), 8);
  assert.match(await page.locator("article").innerText(), /512 × 512/);
  await page.getByText("Curve as a table").click();
  assert.equal(await count("details[open] tbody tr"), 11);
  await page.getByText("Log", { exact: true }).click();
  await page.getByText("loaded the scene in 41 ms").waitFor();
  assert.deepEqual(page.troubles, []);
});

test("a job shows where its time and rays went, and what was built, loaded and left out", async () => {
  await open(views.job);
  const effort = await page.locator(".effort").innerText();
  assert.match(effort, /Time: 42\.9\ss in all/);
  assert.match(effort, /render 30\.0\ss, 69\.9 %/);
  assert.match(effort, /shadow rays 512\s000\s000, 35\.7 %/);
  assert.match(effort, /built\s+skeleton \(1\.50\ss\)\s+loaded\s+octree\s+left out\s+2 of 3 textures/);
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
  assert.equal(await text(".plot-figure .note"), "No errors have been measured.");
});

test("the curve's switches change the plot and the address", async () => {
  await open(views.job);
  const canvas = page.locator(".plot canvas");
  assert.match(await canvas.getAttribute("aria-label"), /^RMSE against render time/);
  await page.getByLabel("Error", { exact: true }).selectOption("est_rmse");
  await page.getByLabel("against", { exact: true }).selectOption("iteration");
  assert.match(await canvas.getAttribute("aria-label"), /^estimated RMSE against iterations/);
  assert.ok(page.url().includes("y=est_rmse"));
  await page.reload();
  await ready(page);
  assert.match(await canvas.getAttribute("aria-label"), /^estimated RMSE against iterations/);
  assert.deepEqual(page.troubles, []);
});

test("hollow points are explained where a reference's floor is reached, and only there", async () => {
  await open(views.job);
  const note = page.getByText("Hollow points");
  assert.equal(await note.isVisible(), true);
  await page.getByLabel("Error", { exact: true }).selectOption("est_rmse");
  assert.equal(await note.isVisible(), false);
});

test("the wheel zooms a PNG under the pointer, a drag and keys move it", async () => {
  await open(views.running);
  const image = page.locator(".frame img");
  await image.waitFor();
  const transform = () => image.evaluate((i) => {
    const { a, e } = new DOMMatrix(getComputedStyle(i).transform);
    return { scale: a, shift: e / i.offsetWidth };
  });
  const rendering = () => image.evaluate((i) => getComputedStyle(i).imageRendering);
  const frame = page.locator(".frame");
  const box = await frame.boundingBox();
  await frame.focus();
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2);
  await page.mouse.wheel(0, -100);
  await page.waitForFunction(() => /scale\(1.25\)/.test(document.querySelector(".frame img").style.transform));
  const before = await transform();
  assert.ok(Math.abs(before.shift - 0.0625) < 0.01, `the point under the pointer stays: ${before.shift}`);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4 + 20, box.y + box.height / 2);
  await page.mouse.up();
  assert.ok(Math.abs((await transform()).shift - before.shift - 20 / box.width) < 0.01, "a drag takes it along");
  await frame.press("0");
  assert.equal((await transform()).scale, 1);
  await frame.press("+");
  await frame.press("+");
  assert.equal((await transform()).scale, 4);
  assert.equal(await rendering(), "pixelated");
  await frame.press("ArrowRight");
  assert.ok((await transform()).shift < 0);
  await frame.press("f");
  assert.equal((await transform()).scale, 1);
  assert.deepEqual(page.troubles, []);
});

test("compare lays as many curves over one another as there are jobs", async () => {
  await open(views.compare);
  assert.equal(await attribute(".plot canvas", "data-curves"), "3");
  const table = await page.locator("main section table").first().innerText();
  for (const name of ["Cornell box, 6 edges", "atrium.glb", "× the fastest"]) assert.ok(table.includes(name), name);
  assert.match(await text(".warning"), /differ in \/scene, \/resolution, \/reference/);
  assert.deepEqual(page.troubles, []);
});

test("compare shows pictures without layers side by side, zoomed together", async () => {
  for (const id of [cornell, shallow]) {
    delete mock.find(id).files["layers.json"];
  }
  await open(views.compare);
  await page.waitForFunction(() => document.querySelectorAll(".gallery img:not([hidden])").length === 3);
  assert.match(await text(".note p"), /no layers.json, so image.png is shown/);
  await page.locator(".frame").first().press("+");
  const transforms = await page.locator(".gallery img").evaluateAll((all) => all.map((i) => i.style.transform));
  assert.equal(new Set(transforms).size, 1, "the pictures are zoomed together");
  assert.match(transforms[0], /scale\(2\)/);
  assert.deepEqual(page.troubles, []);
});

test("compare shows what it can where a job is missing", async () => {
  await open(`/#/compare?jobs=${cornell},nobody`);
  assert.equal(await attribute(".plot canvas", "data-curves"), "1");
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
  assert.deepEqual(page.troubles.filter((t) => !/400/.test(t)), []);
});

test("the new-job view takes a scene into the job and lists every key", async () => {
  await open(views.new);
  await page.getByLabel("Scene").selectOption("door/scene.glb");
  assert.equal(JSON.parse(await page.inputValue("textarea")).scene, "door/scene.glb");
  await page.getByText("Every key of a job file").click();
  assert.match(await page.locator(".keys").innerText(), /\/integrator \(inspect\)\/show\s+word\s+"normal", "albedo"/);
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

test("a server that goes away and comes back is said and forgotten", async (t) => {
  await open(views.jobs);
  const { port } = mock.server.address();
  mock.close();
  await page.getByText("The server does not answer; trying again.").waitFor();
  assert.equal(await count("tr[data-job]"), 6);
  const again = new Mock();
  t.after(() => again.close());
  again.jobs = mock.jobs;
  await again.listen(port);
  await page.getByText("The server does not answer; trying again.").waitFor({ state: "detached" });
});

test("the keyboard reaches the jobs, their boxes and the skip link", async () => {
  await open(views.jobs);
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the content");
  const seen = [];
  for (let i = 0; i < 12; i += 1) {
    await page.keyboard.press("Tab");
    seen.push(await page.evaluate(() => document.activeElement.getAttribute("href")
      ?? document.activeElement.type));
  }
  assert.ok(seen.includes("checkbox") && seen.includes(`#/job/${running}`), seen.join(" "));
});
