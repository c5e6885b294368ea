// The viewer of pictures of numbers, against layers whose values are known.
import assert from "node:assert/strict";
import { test } from "node:test";

import {
  coloursOf, eventually, frames as drawn, giveGraphicsBack, longestTask, ready, screenshot, takeGraphics,
} from "./browser.mjs";
import { layerFiles } from "./layers.mjs";
import { mock, open, origin, page } from "./stage.mjs";

const job = "20260131-101400-cornell";
const other = "20260131-101500-shallow";
const old = "20260131-101900-running";
const rgb = ["R", "G", "B"];

/// Four by two pixels: the estimate is the reference plus (x - 1) / 8 in every channel.
const small = (scale = 1) => layerFiles(4, 2, [
  { name: "", channels: rgb, scale, pixel: (x, y) => [1, 2, 3].map((c) => scale * (c * (y + 1) / 8 + (x - 1) / 8)) },
  { name: "depth", channels: ["Z"], pixel: (x, y) => [x + 4 * y] },
  { name: "reference", channels: rgb, scale, pixel: (x, y) => [1, 2, 3].map((c) => scale * c * (y + 1) / 8) },
]);

const stage = ".stage[data-shown]";
const address = (query = "") => `/#/job/${job}${query}`;

async function openViewer(query, options) {
  await open(address(query), options);
  await page.waitForSelector(stage);
}
const shows = (key) => page.waitForSelector(`.stage[data-shown="${key}"]`);
const readout = () => page.locator(".readout").innerText();
const frames = () => drawn(page);
/// Moves the pointer to the middle of the pixel (x, y) of a picture of `width` pixels that fits.
async function pointAt(x, y, width = 4) {
  await page.locator(stage).scrollIntoViewIfNeeded();
  const box = await page.locator(stage).boundingBox();
  const zoom = box.width / width;
  await page.mouse.move(box.x + (x + 0.5) * zoom, box.y + (y + 0.5) * zoom);
  await frames();
}
/// The colours of pixels of such a picture, beside the values that are printed in them.
async function pixelColours(pixels, width = 4) {
  const zoom = (await page.locator(stage).boundingBox()).width / width;
  await page.mouse.move(0, 0);
  return coloursOf(page, stage, pixels.map(([x, y]) => ({ u: (x + 0.1) * zoom, v: (y + 0.1) * zoom })));
}
const srgb = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055));
function like(found, expected) {
  found.forEach((v, c) => assert.ok(Math.abs(v - expected[c]) <= 1, `${found}, expected ${expected}`));
}
/// Waits until a pixel has the colour whose channels are `expected` before sRGB.
const pixelIs = (x, y, expected) => eventually(async () => {
  const [found] = await pixelColours([[x, y]]);
  like(found, expected.map(srgb));
});

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

const noProblem = async () => assert.deepEqual(await page.locator(".problem:visible").allInnerTexts(), []);

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

/// The other job's estimate is twice this one's.
function openPair(query, options) {
  mock.update(job, { files: small() });
  mock.update(other, { files: layerFiles(4, 2, [
    { name: "", channels: rgb, pixel: (x, y) => [1, 2, 3].map((c) => c * (y + 1) / 4 + (x - 1) / 4) },
    { name: "reference", channels: rgb, pixel: (x, y) => [1, 2, 3].map((c) => c * (y + 1) / 8) }]) });
  return open(`/#/compare?jobs=${job},${other},${old}${query}`, options).then(() => page.waitForSelector(stage));
}

test("number keys flip pictures at one exposure and one zoom", async () => {
  await openPair("&ev=0");
  assert.deepEqual(await page.getByLabel("Show", { exact: true }).locator("option").allInnerTexts(),
    ["picture", "reference", "signed error", "absolute error", "squared error", "relative squared error"]);
  await page.locator(stage).focus();
  await pixelIs(2, 0, [0.25, 0.375, 0.5]);
  await page.keyboard.press("2");
  await frames();
  await pixelIs(2, 0, [0.5, 0.75, 1]);
  assert.ok(page.url().includes("left=1"));
  await page.keyboard.press("3");
  assert.ok(page.url().includes("left=1"), "the third has no layers");
  await page.getByText("No layers.json: image.png").waitFor();
  assert.deepEqual(page.troubles, []);
});

test("a picture of another size is shown apart, and it is said", async () => {
  mock.update(job, { files: small() });
  await open(`/#/compare?jobs=${job},${other}`);
  await page.getByText("Size differs from the first: image.png").waitFor();
  await page.waitForSelector(stage);
  await page.waitForFunction(() => document.querySelectorAll(".gallery img").length === 1);
  assert.deepEqual(page.troubles, []);
});

test("two pictures are split by a line that a drag moves", async () => {
  await openPair("&ev=0&mode=split");
  await pixelIs(2, 0, [0.5, 0.75, 1]);
  await pixelIs(1, 0, [0.125, 0.25, 0.375]);
  const box = await page.locator(stage).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.8 * box.width, box.y + 20);
  await page.mouse.up();
  await pixelIs(2, 0, [0.25, 0.375, 0.5]);
  assert.ok(page.url().includes("split=0.8"));
  for (let i = 0; i < 7; i += 1) await page.locator(stage).press(",");
  await pixelIs(2, 0, [0.5, 0.75, 1]);
  await screenshot(page, "compare-split");
  assert.deepEqual(page.troubles, []);
});

test("two pictures are subtracted, and the address holds how", async () => {
  await openPair("&mode=difference");
  await pointAt(3, 1);
  assert.equal(await readout(), "(3, 1)  0.7500\nx: R 1.000  G 1.500  B 2.000\nr: R 0.5000  G 0.7500  B 1.000");
  await page.getByLabel("by", { exact: true }).selectOption("squared");
  await page.getByText("squared error, (x − r)²; mean").waitFor();
  assert.ok(page.url().includes("mode=difference") && page.url().includes("by=squared"));
  await page.reload();
  await page.getByText("squared error, (x − r)²; mean").waitFor();
  assert.deepEqual(page.troubles, []);
});

test("layers that were replaced meanwhile are all read again", async () => {
  mock.update(job, { files: small() });
  await openViewer();
  // The same layout and so the same layers.json: only the ETag of layers.half tells.
  const twice = layerFiles(4, 2, [
    { name: "", channels: rgb, pixel: (x, y) => [1, 2, 3].map((c) => c * (y + 1) / 8 + 0.5) },
    { name: "depth", channels: ["Z"], pixel: (x, y) => [x + 4 * y] },
    { name: "reference", channels: rgb, pixel: (x, y) => [1, 2, 3].map((c) => c * (y + 1) / 8) }]);
  assert.equal(twice["layers.json"], mock.find(job).files["layers.json"]);
  mock.update(job, { files: twice });
  await page.getByLabel("Show", { exact: true }).selectOption("error-signed");
  await shows("error-signed");
  assert.match(await page.locator(".bar-title").innerText(), /mean 0\.500/);
  // One that the index does not fit yet is not shown.
  mock.update(job, { files: { "layers.half": Buffer.alloc(10) } });
  await page.getByLabel("Show", { exact: true }).selectOption("depth");
  await page.getByText("These layers changed while they were read.").waitFor();
  assert.deepEqual(page.troubles.filter((t) => !/status of 416/.test(t)), []);
});

test("one crop of all jobs at one exposure, chosen by a drag or by keys, and in the address", async () => {
  await openPair("&ev=0&mode=crops");
  await page.waitForSelector(".crops canvas");
  assert.equal(await page.locator(".crops canvas").count(), 2);
  await page.locator(stage).scrollIntoViewIfNeeded();
  const box = await page.locator(stage).boundingBox();
  const at = (x, y) => [box.x + (x * box.width) / 4, box.y + (y * box.height) / 2];
  await page.mouse.move(...at(2.1, 0.1));
  await page.mouse.down();
  await page.mouse.move(...at(3.9, 0.9));
  await page.mouse.up();
  await frames();
  await page.getByText("2 × 1 pixels at (2, 0), 128 times as large.").waitFor();
  assert.ok(page.url().includes("crop=2,0,2,1"), page.url());
  const places = [{ u: 5, v: 5 }, { u: 250, v: 5 }];
  const cropsAre = (gain) => eventually(async () => {
    for (const [i, factor] of [[1, gain], [2, 2 * gain]]) {
      const [left, right] = await coloursOf(page, `.crops figure:nth-child(${i}) canvas`, places);
      like(left, [0.25, 0.375, 0.5].map((v) => srgb(factor * v)));
      like(right, [0.375, 0.5, 0.625].map((v) => srgb(factor * v)));
    }
  });
  await cropsAre(1);
  // Both, the picture's and the crops', are taken away; what is asked for meanwhile is seen afterwards.
  assert.equal(await takeGraphics(page), 2);
  await page.locator(stage).press("E");
  await frames();
  await giveGraphicsBack(page);
  await cropsAre(Math.SQRT1_2);
  await noProblem();
  await page.locator(stage).press("e");
  await cropsAre(1);
  assert.match(await page.locator(".crops figcaption").first().innerText(), /30\.0\ss, rmse 0\.0138/);
  await page.getByText("Of equal time: the jobs' last pictures").waitFor();
  await page.locator(stage).press("ArrowLeft");
  await page.locator(stage).press("ArrowDown");
  await page.getByText("2 × 1 pixels at (1, 1)").waitFor();
  await page.locator(stage).press(".");
  await page.getByText("3 × 2 pixels at (1, 0)").waitFor();
  await screenshot(page, "crops");
  mock.find(other).progress.seconds = 33;
  await page.reload();
  await page.getByText("Not of equal time: the jobs' last pictures, after 30.0\u202fs to 33.0\u202fs of rendering.").waitFor();
  assert.ok(page.url().includes("crop=1,0,3,2"));
  assert.deepEqual(page.troubles, []);
});
