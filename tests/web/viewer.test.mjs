// The viewer of pictures of numbers, against layers whose values are known.
import assert from "node:assert/strict";
import { test } from "node:test";

import { eventually, giveGraphicsBack, longestTask, ready, screenshot, takeGraphics } from "./browser.mjs";
import { mock, open, origin, page } from "./stage.mjs";
import {
  address, frames, job, noProblem, old, openViewer, pixelColours, pixelIs, pointAt, readout, rgb, shows, small, stage,
} from "./viewer_stage.mjs";

test("the pixel under the pointer tells its true values, whatever the scale", async () => {
  for (const [scale, expected] of [[1, "(2, 1)  R 0.3750  G 0.6250  B 0.8750"],
    [2 ** 100, "(2, 1)  R 4.754e29  G 7.923e29  B 1.109e30"], [2 ** -100, "(2, 1)  R 2.958e-31  G 4.930e-31  B 6.903e-31"]]) {
    mock.update(job, { files: small(scale) });
    await openViewer();
    await pointAt(2, 1);
    assert.equal(await readout(), expected);
    // The 95th percentile of luminance is 0.8 of white, so nothing is black or all white.
    await eventually(async () => {
      const [[r, g]] = await pixelColours([[2, 1]]);
      assert.ok(r > 60 && g > r && g < 255, `${r} ${g}`);
    });
    assert.deepEqual(page.troubles, []);
    await page.goto("about:blank");
  }
});

test("exposure and sRGB are what the screen shows", async () => {
  mock.update(job, { files: small() });
  await openViewer("?ev=-1");
  await pixelIs(2, 1, [0.375 / 2, 0.625 / 2, 0.875 / 2]);
  await pixelIs(2, 0, [0.25 / 2, 0.375 / 2, 0.5 / 2]);
  await page.locator(stage).press("e");
  await page.locator(stage).press("e");
  await pixelIs(2, 1, [0.375, 0.625, 0.875]);
  assert.ok(page.url().includes("ev=0"));
  await page.locator(stage).press("E");
  assert.ok(page.url().includes("ev=-0.5"));
  assert.deepEqual(page.troubles, []);
});

test("errors against the reference are the project's, with their mean and their colours", async () => {
  mock.update(job, { files: small() });
  await openViewer("?show=error-relative");
  await shows("error-relative");
  await pointAt(3, 0);
  const relative = [1, 2, 3].map((c) => 0.25 ** 2 / ((c / 8) ** 2 + 0.01)).reduce((a, b) => a + b) / 3;
  assert.equal(await readout(), `(3, 0)  ${relative.toPrecision(4)}\nx: R 0.3750  G 0.5000  B 0.6250`
    + "\nr: R 0.1250  G 0.2500  B 0.3750");
  const mean = async (key) => {
    await page.getByLabel("Show", { exact: true }).selectOption(key);
    await shows(key);
    return /mean (\S+)/.exec(await page.locator(".bar-title").innerText())[1];
  };
  assert.equal(await mean("error-signed"), (0.25 / 4).toPrecision(3));
  assert.equal(await mean("error-absolute"), "0.125");
  assert.equal(await mean("error-squared"), ((1 + 0 + 1 + 4) / 64 / 4).toPrecision(3));
  assert.match(await page.locator(".bar-title").innerText(), /\(MSE\)/);
  await page.getByLabel("Show", { exact: true }).selectOption("error-signed");
  await shows("error-signed");
  await eventually(async () => {
    const [below, none, above] = await pixelColours([[0, 0], [1, 0], [3, 0]]);
    assert.ok(below[2] > below[0] + 50, `below: blue, not ${below}`);
    assert.ok(above[0] > above[2] + 50, `above: orange, not ${above}`);
    assert.ok(Math.max(...none) < 60, `none: dark, not ${none}`);
  });
  assert.deepEqual(await page.locator(".bar-labels span").allInnerTexts(),
    ["-0.500", "-0.250", "0", "0.250", "0.500"]);
  assert.deepEqual(page.troubles, []);
});

test("a layer of one channel has a colour bar with its range; a layer is read alone", async () => {
  mock.update(job, { files: small() });
  await openViewer();
  assert.equal(mock.requests.filter((r) => r.includes("layers.half")).length, 1);
  await page.locator(stage).press("]");
  await shows("depth");
  assert.equal(mock.requests.filter((r) => r.includes("layers.half")).length, 2);
  assert.equal(await page.locator(".bar-title").innerText(), "depth");
  assert.deepEqual(await page.locator(".bar-labels span").allInnerTexts(), ["1.00", "2.50", "4.00", "5.50", "7.00"]);
  await pointAt(3, 1);
  assert.equal(await readout(), "(3, 1)  7.000");
  await page.locator(stage).press("[");
  await page.locator(stage).press("[");
  await shows("error-relative");
  assert.deepEqual(page.troubles, []);
});

test("zoom, place, layer and exposure go into the address and come back", async () => {
  await openViewer();
  const frame = page.locator(stage);
  const zoom = () => frame.getAttribute("data-zoom").then(Number);
  const fitted = await zoom();
  const box = await frame.boundingBox();
  await frame.focus();
  await pointAt(32, 32, 128);
  const under = await readout();
  for (let i = 0; i < 4; i += 1) await page.mouse.wheel(0, -100);
  await page.waitForFunction((z) => Number(document.querySelector(".stage").dataset.zoom) > 2 * z, fitted);
  assert.equal(await readout(), under, "the pixel under the pointer stays there");
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.up();
  await frames();
  assert.equal(await readout(), under, "a drag takes the picture along");
  await frame.press("]");
  await shows("variance");
  const before = await zoom();
  await page.mouse.move(0, 0);
  await frames();
  const middle = await readout();
  for (const key of ["show=variance", "zoom=", "at="]) assert.ok(page.url().includes(key), page.url());
  await page.reload();
  await ready(page);
  await shows("variance");
  assert.equal(await zoom(), before);
  assert.equal(await readout(), middle);
  await frame.press("o");
  await page.waitForSelector(".stage[data-zoom='1']");
  await frame.press("0");
  await frames();
  assert.equal(await zoom(), fitted);
  assert.ok(!page.url().includes("zoom="));
  assert.deepEqual(page.troubles, []);
});

test("magnified pixels carry their values and keep sharp edges", async () => {
  await openViewer("?zoom=96&at=0.2,0.5");
  const blank = () => page.locator(".pixel-text").evaluate((canvas) => canvas.toDataURL()
    === Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height }).toDataURL());
  assert.equal(await blank(), false);
  await screenshot(page, "viewer-magnified");
  await page.locator(stage).press("0");
  await frames();
  assert.equal(await blank(), true);
  assert.deepEqual(page.troubles, []);
});

test("the error picture in light and dark, wide and narrow", async () => {
  await openViewer("?show=error-signed");
  await shows("error-signed");
  for (const [colorScheme, width] of [["light", 1280], ["dark", 1280], ["dark", 400], ["light", 400]]) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 900 });
    await frames();
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
    await screenshot(page, `viewer-error-${colorScheme}-${width}`);
  }
  assert.deepEqual(page.troubles, []);
});

/// A picture of some size with noise in it, made fast: the halves of 1/2 to 1, by hash.
function large(width, height) {
  const bytes = 6 * width * height;
  const data = new Uint16Array(bytes);
  for (let i = 0; i < data.length; i += 1) data[i] = 0x3800 + (Math.imul(i, 2654435761) >>> 22);
  const layers = ["", "reference"].map((name, i) => ({ name, channels: rgb, offset: i * bytes, bytes, scale: 1 }));
  return { "layers.json": JSON.stringify({ width, height, layers }), "layers.half": Buffer.from(data.buffer) };
}

test("errors of a large picture are computed by a worker, and the page stays quick", async () => {
  mock.update(job, { files: large(2048, 1024) });
  await openViewer();
  await frames();
  const loading = await longestTask(page, true);
  await page.computed();
  await page.getByLabel("Show", { exact: true }).selectOption("error-absolute");
  await shows("error-absolute");
  const errors = await longestTask(page);
  const busy = await page.computed();
  console.log(`# 2048 x 1024: longest task ${loading} ms until the picture is seen, ${errors} ms for its errors (0: none above 50), `
    + `for which the page computed ${busy} ms`);
  assert.deepEqual(page.workers().map((w) => new URL(w.url()).pathname), ["/error_worker.js"]);
  assert.ok(busy < 1000, `${busy} ms`);
  assert.deepEqual(page.troubles, []);
});

test("what is still computed is shown to be, over the picture before it; so is what is read first", async () => {
  await open("/#/");
  const held = [];
  const hold = (route) => held.push(route);
  const letGo = () => held.splice(0).forEach((route) => route.continue());
  const ring = () => page.locator(".stage").evaluate((frame) => ({
    busy: frame.ariaBusy, size: getComputedStyle(frame, "::after").width }));
  /// The ring is there, and no longer in the 50 ms in which it is not seen.
  const turns = async () => {
    const frame = await page.waitForSelector(".stage[aria-busy=true]");
    await page.waitForFunction((stage) => getComputedStyle(stage, "::after").opacity === "1", frame);
    assert.equal((await ring()).size, "36px");
  };
  await page.context().route(/layers\.half|error_worker/, hold);
  await page.goto(origin + address());
  await turns();
  assert.equal(await page.locator(".stage").getAttribute("data-shown"), null);
  letGo();
  await page.waitForSelector(".stage[data-shown=picture][aria-busy=false]");
  await page.getByLabel("Show", { exact: true }).selectOption("reference");
  await turns();
  letGo();
  await page.waitForSelector(".stage[data-shown=reference][aria-busy=false]");
  await page.getByLabel("Show", { exact: true }).selectOption("error-signed");
  await turns();
  await screenshot(page, "viewer-busy");
  assert.equal(await page.locator(".stage").getAttribute("data-shown"), "reference");
  assert.deepEqual(held.map((route) => new URL(route.request().url()).pathname), ["/error_worker.js"]);
  letGo();
  await page.waitForSelector(".stage[data-shown=error-signed][aria-busy=false]");
  assert.deepEqual(await ring(), { busy: "false", size: "auto" });
  await page.context().unrouteAll();
  assert.deepEqual(page.troubles, []);
});

test("a job without layers shows image.png and says why", async () => {
  await open(`/#/job/${old}`);
  await page.getByText("Preview: the latest tone-mapped image.png.").waitFor();
  await page.waitForFunction(() => document.querySelector(".frame img")?.naturalWidth === 160);
  mock.update(old, { progress: mock.find(job).progress });
  mock.update(old, { files: { "image.png": mock.find(job).files["image.png"], ...small() } });
  mock.update(old, { state: { state: "done" } });
  await page.waitForSelector(stage);
  assert.equal(await page.getByText("Preview: the latest").isVisible(), false);
  delete mock.find(job).files["layers.json"];
  await page.goto(origin + address());
  await page.getByText("This job has no layers.json (written by newer versions)").waitFor();
  assert.deepEqual(page.troubles, []);
});

test("a browser without WebGL 2 shows image.png and says why", async () => {
  await open("/#/new");
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function context(kind, ...more) {
      return kind === "webgl2" ? null : get.call(this, kind, ...more);
    };
  });
  await page.reload();
  await page.goto(origin + address());
  await page.getByText("This browser has no WebGL 2").waitFor();
  await page.waitForFunction(() => document.querySelector(".frame img")?.naturalWidth === 128);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test("a layer that cannot be read is said; the picture before it stays", async () => {
  await openViewer();
  delete mock.find(job).files["layers.half"];
  await page.getByLabel("Show", { exact: true }).selectOption("depth");
  await page.getByText("There is no file layers.half.").waitFor();
  assert.equal(await page.locator(".stage").getAttribute("data-shown"), "picture");
  mock.close();
  await page.getByLabel("Show", { exact: true }).selectOption("normal");
  await page.getByText(/No answer from .* Is lacuna-server running\?/).waitFor();
});

test("graphics that were taken away and given back: the picture is there again, as it was asked for meanwhile", async () => {
  mock.update(job, { files: small() });
  await openViewer("?ev=0");
  await pixelIs(2, 1, [0.375, 0.625, 0.875]);
  assert.equal(await takeGraphics(page), 1);
  await noProblem();
  await giveGraphicsBack(page);
  await pixelIs(2, 1, [0.375, 0.625, 0.875]);

  assert.equal(await takeGraphics(page), 1);
  await page.getByLabel("Show", { exact: true }).selectOption("reference");
  await shows("reference");
  await page.locator(stage).press("E");
  await frames();
  await noProblem();
  await giveGraphicsBack(page);
  await pixelIs(2, 1, [0.25, 0.5, 0.75].map((v) => v * Math.SQRT1_2));
  await pointAt(2, 1);
  assert.equal(await readout(), "(2, 1)  R 0.2500  G 0.5000  B 0.7500");
  await noProblem();
  assert.deepEqual(page.troubles, []);
});
