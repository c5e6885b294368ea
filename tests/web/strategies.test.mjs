// The pyramid of strategies and the row of distributions, against layers whose values are known.
import assert from "node:assert/strict";
import { test } from "node:test";

import { coloursOf, frames, longestTask, screenshot } from "./browser.mjs";
import { layerFiles } from "./layers.mjs";
import { radiance } from "./png.mjs";
import { mock, open, page } from "./stage.mjs";

const job = "20260131-101400-cornell";
const rgb = ["R", "G", "B"];

/// All s, t with s + t - 1 edges, t at least 1.
const strategies = (longest) => Array.from({ length: longest }, (_, i) => i + 1).flatMap((edges) =>
  Array.from({ length: edges + 1 }, (_, s) => ({ edges, s, t: edges + 1 - s })));

/// Eight by four pixels. The picture is 1 everywhere; s of k + 1 strategies of k edges adds as much as any other of
/// them, and unweighted each is all that the paths of this length bring: 2^-k, but for s = 0, black in the right half.
function known(sets = ["strategies", "strategies_unweighted"], distributions = ["paired", "skeleton"]) {
  const grey = (value) => [value, value, value];
  const light = ({ edges, s }, x) => (s === 0 && x >= 4 ? 0 : 2 ** -edges);
  return layerFiles(8, 4, [
    { name: "", channels: rgb, pixel: () => grey(1) },
    ...sets.flatMap((set) => strategies(3).map((of) => ({ name: `${set}.s${of.s}t${of.t}`, channels: rgb,
      pixel: (x) => grey(light(of, x) / (set === "strategies" ? of.edges + 1 : 1)) }))),
    ...distributions.map((name, i) => ({ name: `distributions.${name}`, channels: rgb, pixel: () => grey(0.25 + i / 2) })),
    { name: "reference", channels: rgb, pixel: () => grey(1) },
  ]);
}

/// Also where the page was at this address before.
async function openStrategies(query = "", options = undefined) {
  await page?.goto("about:blank");
  await open(`/#/job/${job}${query}`, options);
  await page.waitForSelector(".stage[data-shown]");
  await page.locator(".cell").first().waitFor();
  await page.locator(".pyramid, .distributions").first().scrollIntoViewIfNeeded();
  await drawn();
}
const drawn = async () => {
  await page.waitForSelector("[aria-busy=false] .cell");
  await frames(page);
};
const cells = (within = "") => page.locator(`${within} .cell`).evaluateAll((all) => all.map((c) =>
  c.innerText.replaceAll("\u202f", " ").split("\n").join(": ")));
const cell = (name) => page.getByRole("button", { name, exact: false });
const srgb = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055));
/// The colours of the left and of the right half of a cell.
async function halves(n) {
  const selector = `.cell >> nth=${n} >> canvas`;
  const { width, height } = await page.locator(selector).boundingBox();
  return (await coloursOf(page, selector, [0.25, 0.75].map((u) => ({ u: u * width, v: height / 2 })))).map(([r]) => r);
}
function near(found, expected) {
  found.forEach((v, i) => assert.ok(Math.abs(v - expected[i]) <= 1, `${found}, expected ${expected}`));
}

test("strategies stand in a row for each path length and a column for each s, with their shares", async () => {
  mock.update(job, { files: known() });
  await openStrategies();
  assert.deepEqual(await page.locator(".pyramid > span").allInnerTexts(), ["1 edge", "2 edges", "3 edges"]);
  assert.deepEqual(await cells(".pyramid"), ["s 0 t 2: 12.5 %", "s 1 t 1: 25.0 %", "s 0 t 3: 4.17 %", "s 1 t 2: 8.33 %",
    "s 2 t 1: 8.33 %", "s 0 t 4: 1.56 %", "s 1 t 3: 3.13 %", "s 2 t 2: 3.13 %", "s 3 t 1: 3.13 %"]);
  const boxes = await page.locator(".pyramid .cell").evaluateAll((all) => all.map((c) => {
    const { x, y } = c.getBoundingClientRect();
    return [Math.round(x), Math.round(y)];
  }));
  const at = strategies(3);
  at.forEach((a, i) => at.forEach((b, j) => {
    assert.equal(boxes[i][0] === boxes[j][0], a.s === b.s, `columns of ${i} and ${j}`);
    assert.equal(boxes[i][1] === boxes[j][1], a.edges === b.edges, `rows of ${i} and ${j}`);
  }));
  assert.deepEqual(await cells(".distributions"), ["paired: 25.0 %", "skeleton: 75.0 %"]);
  assert.deepEqual(page.troubles, []);
});

test("merging stands to the right of the joining strategies, with the share of each kind", async () => {
  const grey = (value) => [value, value, value];
  mock.update(job, { files: layerFiles(8, 4, [
    { name: "", channels: rgb, pixel: () => grey(1) },
    ...strategies(2).map(({ s, t }) => ({ name: `strategies.s${s}t${t}`, channels: rgb, pixel: () => grey(1 / 8) })),
    { name: "strategies.s2t2m", channels: rgb, pixel: () => grey(3 / 8) },
  ]) });
  await openStrategies();
  assert.deepEqual(await cells(".pyramid"), ["s 0 t 2: 12.5 %", "s 1 t 1: 12.5 %", "s 0 t 3: 12.5 %", "s 1 t 2: 12.5 %",
    "s 2 t 1: 12.5 %", "s 2 t 2 merged: 37.5 %"]);
  const last = await page.locator(".pyramid .cell").evaluateAll((all) => all.slice(-2).map((c) => {
    const { x, y } = c.getBoundingClientRect();
    return [Math.round(x), Math.round(y)];
  }));
  assert.ok(last[1][0] > last[0][0] && last[1][1] === last[0][1], `${last}`);
  const text = (await page.locator("section", { has: page.locator(".pyramid") }).innerText()).replaceAll("\u202f", " ");
  assert.match(text, /hit 25.0 %, connected 37.5 %, merged 37.5 %/);
  assert.deepEqual(page.troubles, []);
});

test("all have one exposure: the picture's own, until the reader chooses another", async () => {
  mock.update(job, { files: known() });
  await openStrategies();
  // 95 % of the picture are at most 1, which becomes 0.8 of white, to a tenth of a stop.
  const own = 2 ** -0.3;
  near(await halves(0), [srgb(own / 4), 0]);
  near(await halves(1), [srgb(own / 4), srgb(own / 4)]);
  near(await halves(8), [srgb(own / 32), srgb(own / 32)]);
  near(await halves(10), [srgb(own * 0.75), srgb(own * 0.75)]);
  const field = page.locator("section:has(> div .pyramid)").getByLabel("Exposure in stops");
  assert.equal(await field.inputValue(), "-0.3");
  await field.fill("2");
  await page.waitForFunction(() => location.href.includes("stops-each=2"));
  for (let i = 0; i < 12; i += 1) await frames(page);
  near(await halves(8), [srgb(4 / 32), srgb(4 / 32)]);
  await openStrategies("?stops-each=2");
  near(await halves(8), [srgb(4 / 32), srgb(4 / 32)]);
  await page.locator("section:has(> div .pyramid)").getByRole("button", { name: "Automatic exposure" }).click();
  for (let i = 0; i < 12; i += 1) await frames(page);
  near(await halves(0), [srgb(own / 4), 0]);
  assert.ok(!page.url().includes("stops-each"));
  assert.deepEqual(page.troubles, []);
});

test("before weighting, each is told by its mean, and the choice is in the address", async () => {
  mock.update(job, { files: known() });
  await openStrategies();
  await page.getByLabel("Strategies", { exact: true }).selectOption("before weighting");
  await drawn();
  assert.deepEqual((await cells(".pyramid")).slice(0, 5),
    ["s 0 t 2: 0.250", "s 1 t 1: 0.500", "s 0 t 3: 0.125", "s 1 t 2: 0.250", "s 2 t 1: 0.250"]);
  await page.getByText("Each image estimates all light of its path length").waitFor();
  assert.match(page.url(), /strategies=strategies_unweighted/);
  await openStrategies("?strategies=strategies_unweighted");
  assert.equal((await cells(".pyramid"))[1], "s 1 t 1: 0.500");
  assert.deepEqual(page.troubles, []);
});

test("a click opens the layer in the viewer, which has the focus then", async () => {
  mock.update(job, { files: known() });
  await openStrategies();
  await cell("s\u202f2 t\u202f1, 2 edges").click();
  await page.waitForSelector(".stage[data-shown='strategies.s2t1']");
  assert.match(page.url(), /show=strategies\.s2t1/);
  assert.equal(await page.evaluate(() => document.activeElement.className), "stage");
  const groups = await page.getByLabel("Show", { exact: true }).locator("optgroup").evaluateAll((all) =>
    all.map((g) => `${g.label}: ${g.children.length} ${g.children[0].label}`));
  assert.deepEqual(groups, ["Layers: 2 picture", "strategies: 9 s0t2", "strategies unweighted: 9 s0t2",
    "distributions: 2 paired", "Error against the reference: 4 signed error"]);
  await cell("skeleton:").click();
  await page.waitForSelector(".stage[data-shown='distributions.skeleton']");
  assert.deepEqual(page.troubles, []);
});

test("a job may have one set of them, or distributions alone, or none, and is then left in peace", async () => {
  mock.update(job, { files: known(["strategies_unweighted"], []) });
  await openStrategies();
  assert.equal(await page.getByLabel("Strategies", { exact: true }).isVisible(), false);
  assert.equal((await cells())[1], "s 1 t 1: 0.500");
  assert.equal(await page.locator(".distributions").count(), 0);
  mock.update(job, { files: known([], ["<img src=x>"]) });
  await openStrategies();
  assert.deepEqual(await cells(), ["<img src=x>: 25.0 %"]);
  await page.getByRole("heading", { name: "Resampling distributions" }).waitFor();
  assert.equal(await page.locator(".pyramid").count(), 0);
  mock.reset();
  await page.goto("about:blank");
  await open(`/#/job/${job}`);
  await page.waitForSelector(".stage[data-shown]");
  assert.equal(await page.locator(".cell").count(), 0);
  assert.ok(!mock.requests.includes("GET /strategies.js"), "nobody reads what nobody needs");
  assert.deepEqual(page.troubles, []);
});

test("what cannot be read is said", async () => {
  mock.update(job, { files: known() });
  await openStrategies();
  mock.update(job, { files: { "layers.half": Buffer.alloc(10) } });
  await page.getByLabel("Strategies", { exact: true }).selectOption("before weighting");
  await page.getByText("These layers changed while they were read.").waitFor();
  assert.deepEqual(page.troubles.filter((t) => !/416/.test(t)), []);
});

/// A room of `side` pixels: s of its strategies find the light in different places.
function room(width, height, longest) {
  const at = radiance(width, height, 0.2, 5);
  const share = ({ edges, s }, x) => Math.exp(-((x / width - s / edges) ** 2) * 6) / (edges + 1) / edges;
  return layerFiles(width, height, [
    { name: "", channels: rgb, scale: 2 ** -10, pixel: at },
    ...["strategies", "strategies_unweighted"].flatMap((set) => strategies(longest).map((of) => ({
      name: `${set}.s${of.s}t${of.t}`, channels: rgb, scale: 2 ** -12,
      pixel: (x, y) => at(x, y).map((v) => v * (set === "strategies" ? share(of, x) : 1 / of.edges)) }))),
    ...["paired", "uniform", "skeleton", "importance_cache"].map((name, i) => ({ name: `distributions.${name}`,
      channels: rgb, scale: 2 ** -12, pixel: (x, y) => at(x, y).map((v) => (v * (1 + i)) / 10) })),
  ]);
}

test("the pyramid in light and dark, wide and narrow", async () => {
  mock.update(job, { files: room(192, 128, 6) });
  for (const [colorScheme, width] of [["light", 1280], ["dark", 1280], ["dark", 400], ["light", 340]]) {
    await openStrategies("?stops-each=3", { colorScheme, viewport: { width, height: 900 } });
    for (let i = 0; i < 40; i += 1) await frames(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
    await screenshot(page, `strategies-${colorScheme}-${width}`);
  }
  assert.deepEqual(page.troubles, []);
});

test("large layers are made small without a long pause", async () => {
  const [width, height] = [2048, 1024];
  const bytes = 6 * width * height;
  const names = ["", "strategies.s0t2", "strategies.s1t1", "strategies.s0t3"];
  const data = new Uint16Array(bytes / 2).map((_, i) => 0x3800 + (Math.imul(i, 2654435761) >>> 22));
  const half = Buffer.concat(names.map(() => Buffer.from(data.buffer)));
  const layers = names.map((name, i) => ({ name, channels: rgb, offset: i * bytes, bytes, scale: 1 }));
  mock.update(job, { files: { "layers.json": JSON.stringify({ width, height, layers }), "layers.half": half } });
  await open(`/#/job/${job}`);
  await page.waitForSelector(".stage[data-shown]");
  await frames(page);
  await longestTask(page, true);
  await page.computed();
  await page.locator(".pyramid").scrollIntoViewIfNeeded();
  await drawn();
  const longest = await longestTask(page);
  const busy = await page.computed();
  console.log(`# 2048 x 1024: longest task ${longest} ms until the pyramid is seen (0: none above 50), `
    + `for which the page computed ${busy} ms`);
  assert.ok(busy < 1000, `${busy} ms`);
  assert.deepEqual(await cells(), ["s 0 t 2: 100 %", "s 1 t 1: 100 %", "s 0 t 3: 100 %"]);
  assert.deepEqual(page.troubles, []);
});
