// The viewer of several jobs: flipped, split, subtracted, and one crop of all.
import assert from "node:assert/strict";
import { test } from "node:test";

import { coloursOf, eventually, giveGraphicsBack, screenshot, takeGraphics } from "./browser.mjs";
import { layerFiles } from "./layers.mjs";
import { mock, open, page } from "./stage.mjs";
import {
  frames, job, like, noProblem, old, openViewer, other, pixelIs, pointAt, readout, rgb, shows, small, srgb, stage,
} from "./viewer_stage.mjs";

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
