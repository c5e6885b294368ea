// The viewer of a job, and what its pixels show.
import assert from "node:assert/strict";

import { coloursOf, eventually, frames as drawn } from "./browser.mjs";
import { layerFiles } from "./layers.mjs";
import { open, page } from "./stage.mjs";

export const job = "20260131-101400-cornell";
export const other = "20260131-101500-shallow";
export const old = "20260131-101900-running";
export const rgb = ["R", "G", "B"];

/// Four by two pixels: the estimate is the reference plus (x - 1) / 8 in every channel.
export const small = (scale = 1) => layerFiles(4, 2, [
  { name: "", channels: rgb, scale, pixel: (x, y) => [1, 2, 3].map((c) => scale * (c * (y + 1) / 8 + (x - 1) / 8)) },
  { name: "depth", channels: ["Z"], pixel: (x, y) => [x + 4 * y] },
  { name: "reference", channels: rgb, scale, pixel: (x, y) => [1, 2, 3].map((c) => scale * c * (y + 1) / 8) },
]);

export const stage = ".stage[data-shown]";
export const address = (query = "") => `/#/job/${job}${query}`;

export async function openViewer(query, options) {
  await open(address(query), options);
  await page.waitForSelector(stage);
}
export const shows = (key) => page.waitForSelector(`.stage[data-shown="${key}"]`);
export const readout = () => page.locator(".readout").innerText();
export const frames = () => drawn(page);
/// Moves the pointer to the middle of the pixel (x, y) of a picture of `width` pixels that fits.
export async function pointAt(x, y, width = 4) {
  await page.locator(stage).scrollIntoViewIfNeeded();
  const box = await page.locator(stage).boundingBox();
  const zoom = box.width / width;
  await page.mouse.move(box.x + (x + 0.5) * zoom, box.y + (y + 0.5) * zoom);
  await frames();
}
/// The colours of pixels of such a picture, beside the values that are printed in them.
export async function pixelColours(pixels, width = 4) {
  const zoom = (await page.locator(stage).boundingBox()).width / width;
  await page.mouse.move(0, 0);
  return coloursOf(page, stage, pixels.map(([x, y]) => ({ u: (x + 0.1) * zoom, v: (y + 0.1) * zoom })));
}
export const srgb = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055));
export function like(found, expected) {
  found.forEach((v, c) => assert.ok(Math.abs(v - expected[c]) <= 1, `${found}, expected ${expected}`));
}
/// Waits until a pixel has the colour whose channels are `expected` before sRGB.
export const pixelIs = (x, y, expected) => eventually(async () => {
  const [found] = await pixelColours([[x, y]]);
  like(found, expected.map(srgb));
});
export const noProblem = async () => assert.deepEqual(await page.locator(".problem:visible").allInnerTexts(), []);
