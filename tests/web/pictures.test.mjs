// The arithmetic of pictures: exposure, errors, crops, the order of layers, and the marks of figures.
import assert from "node:assert/strict";
import { test } from "node:test";

import { call, page } from "./module_page.mjs";

test("a stop up shows values half as large as bright as before, in each look", async () => {
  const colour = await call("/paint.js", "exposed", { look: "colour", ev: 1 }, { ev: null, stops: 0 });
  const brighter = await call("/paint.js", "exposed", { look: "colour", ev: 1 }, { ev: 2, stops: 0 });
  assert.equal(brighter.gain, 2 * colour.gain);
  const ends = async (map, low, stops) => {
    const { low: from, high: to } = await call("/paint.js", "exposed", { look: "false", map, low, high: 8 }, { stops });
    return [from, to];
  };
  assert.deepEqual(await ends("sequential", 0, 1), [0, 4]);
  assert.deepEqual(await ends("sequential", 0, -1), [0, 16]);
  assert.deepEqual(await ends("diverging", -8, 1), [-4, 4]);
});

test("errors are those of the values: each picture has its own scale", async () => {
  const picture = (data, scale) => ({ width: 2, height: 1, channels: ["R"], data, scale });
  const { mean, data, scale } = await call("/errors.js", "errorPicture", picture([6, 2], 0.5), picture([1, 3], 2), "signed");
  assert.equal(mean, ((3 - 2) + (1 - 6)) / 2);
  assert.deepEqual(Object.values(data).map((v) => v * scale), [1, -5]);
});

test("a crop has the picture's own pixels", async () => {
  const data = Array.from({ length: 12 }, (_, i) => i);
  const found = await page.evaluate(async (values) => {
    const { cut } = await import("/pixels.js");
    const image = { width: 4, height: 3, channels: ["Y"], scale: 1, data: Float32Array.from(values) };
    return [...cut(image, { x: 1, y: 1, w: 2, h: 2 }).data];
  }, data);
  assert.deepEqual(found, [5, 6, 9, 10]);
});

test("before the first layer is the last one, and after it the first", async () => {
  const shown = await page.evaluate(async () => {
    const { viewerActions } = await import("/viewer_controls.js");
    const state = { show: "" };
    const change = (values) => Object.assign(state, values);
    const { cycle } = viewerActions({ state, change, options: ["", "depth", "normal"].map((key) => ({ key })) });
    const by = (step) => { cycle(step); return state.show; };
    return [by(-1), by(1), by(1)];
  });
  assert.deepEqual(shown, ["normal", "", "depth"]);
});

test("points at the reference's noise are hollow, others are filled", async () => {
  const fills = await page.evaluate(async () => {
    const { figureSvg } = await import("/figure.js");
    const points = [{ x: 1, y: 1 }, { x: 2, y: 0.5, floor: true }];
    const axis = { label: "x", unit: "s" };
    const figure = figureSvg({ curves: [{ name: "a", index: 0, points }], axis, metric: { label: "y" } });
    return [...figure.querySelectorAll(".curve circle")].map((mark) => mark.getAttribute("fill"));
  });
  assert.deepEqual(fills, ["var(--curve-0)", "var(--surface)"]);
});
