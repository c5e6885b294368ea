// The page's arithmetic and its texts, in the browser it is written for.
import assert from "node:assert/strict";
import { test } from "node:test";

import { openPage } from "./browser.mjs";
import { browser, call, page } from "./module_page.mjs";

const near = (actual, expected) => assert.ok(Math.abs(actual / expected - 1) < 1e-12,
  `${actual}, expected ${expected}`);

/// y = level / sqrt(x) at the given x.
const halfSlope = (level, xs) => xs.map((x) => ({ x, y: level / Math.sqrt(x), floor: false }));

test("curve.csv: empty fields are no values, and points that log axes cannot show are left out", async () => {
  const text = "iteration,seconds,rmse,est_rmse,at_floor\n1,0,0.5,,0\n2,0.2,,0.4,0\n4,0.4,0.25,0,1\n";
  const rows = await call("/curve.js", "parseCurve", text);
  assert.deepEqual(rows[1], { iteration: 2, seconds: 0.2, rmse: null, est_rmse: 0.4, at_floor: 0 });
  assert.deepEqual(await call("/curve.js", "points", rows, "seconds", "rmse"), [{ x: 0.4, y: 0.25, floor: true }]);
  assert.deepEqual(await call("/curve.js", "points", rows, "seconds", "est_rmse"), [{ x: 0.2, y: 0.4, floor: false }]);
  assert.deepEqual((await call("/curve.js", "presentMetrics", rows)).map((m) => m.key), ["rmse", "est_rmse"]);
  assert.deepEqual(await call("/curve.js", "parseCurve", ""), []);
});

test("errors and times are interpolated in log-log, and never beyond the curve", async () => {
  const curve = halfSlope(1, [1, 4, 64]);
  near(await call("/curve.js", "errorAt", curve, 16), 0.25);
  near(await call("/curve.js", "errorAt", curve, 2), Math.SQRT1_2);
  assert.equal(await call("/curve.js", "errorAt", curve, 1), 1);
  assert.equal(await call("/curve.js", "errorAt", curve, 0.5), null);
  assert.equal(await call("/curve.js", "errorAt", curve, 65), null);
  near(await call("/curve.js", "reaches", curve, 0.25), 16);
  assert.equal(await call("/curve.js", "reaches", curve, 0.1), null);
});

test("an error counts as reached where a point has exactly this value, the last one too", async () => {
  const curve = [{ x: 1, y: 1 }, { x: 2, y: 0.5 }, { x: 4, y: 0.25 }];
  assert.equal(await call("/curve.js", "reaches", curve, 0.25), 4);
  assert.equal(await call("/curve.js", "reaches", curve, 1), 1);
  assert.equal(await call("/curve.js", "reaches", [{ x: 1, y: 0.5 }, { x: 2, y: 0.5 }], 0.5), 1);
  assert.equal(await call("/curve.js", "reaches", curve, 0.2), null);
});

test("instants and errors that all curves share", async () => {
  const curves = [halfSlope(1, [1, 200]), halfSlope(4, [3, 100]), []];
  assert.deepEqual(await call("/curve.js", "commonInstants", curves), [10, 25, 50, 100]);
  near(await call("/curve.js", "commonError", curves), 0.4);
  assert.deepEqual(await call("/curve.js", "commonInstants", [halfSlope(1, [1, 2]), halfSlope(1, [3, 4])]), []);
  assert.equal(await call("/curve.js", "commonError", [[]]), null);
});

test("the slope line lies on a curve that has the slope, and points at the floor do not bend it", async () => {
  const curve = [...halfSlope(3, [1, 4, 16]), { x: 64, y: 2, floor: true }];
  const [from, to] = await call("/curve.js", "slopeLine", [curve], -0.5);
  near(from.y, 3);
  assert.equal(to.x, 64);
  near(to.y, 3 / 8);
  assert.deepEqual(await call("/curve.js", "slopeLine", [curve.slice(0, 1)], -0.5), []);
});

test("ticks of log axes lie within them, a few for any range", async () => {
  for (const [min, max] of [[0.02, 40], [1.1, 1.2], [1, 9], [1e-9, 1e9], [3e-5, 4e-5], [90, 1100]]) {
    const ticks = await call("/figure.js", "logTicks", min, max);
    assert.ok(ticks.length >= 2 && ticks.length <= 11, `${min} to ${max}: ${ticks}`);
    assert.ok(ticks.every((t, i) => t >= min && t <= max && (i === 0 || t > ticks[i - 1])), `${ticks}`);
  }
});

test("numbers are written with three digits, whole ones in full", async () => {
  const written = { 0: "0", 7: "7", 1234567: "1\u202f234\u202f567", 0.0123456: "0.0123", 12.345: "12.3",
    123.45: "123", 0.000123: "1.23e-4", 2500000.5: "2.50e6" };
  for (const [value, text] of Object.entries(written)) {
    assert.equal(await call("/format.js", "number", Number(value)), text);
  }
  assert.equal(await call("/format.js", "number", null), "—");
  assert.equal(await call("/format.js", "duration", 59.6), "1 min 0 s");
  assert.equal(await call("/format.js", "duration", 7500), "2 h 5 min");
  assert.equal(await call("/format.js", "duration", 7559), "2 h 5 min");
  assert.equal(await call("/format.js", "duration", 86400 + 3600), "1 d 1 h");
  assert.equal(await call("/format.js", "bytes", 1536), "1.50\u202fKiB");
  assert.equal(await call("/format.js", "quantity", 2.5e7, ["rays_per_second"]), "25.0\u202fM/s");
  assert.equal(await call("/format.js", "quantity", 0.5, ["load", "seconds"]), "0.500\u202fs");
});

test("instants are shown in the reader's time zone", async () => {
  const east = await openPage(browser, page.url(), { timezoneId: "Asia/Kolkata" });
  const shown = await east.evaluate(async () => {
    const { when } = await import("/format.js");
    return ["2026-01-31T23:59:59.123Z", ""].map(when);
  });
  assert.deepEqual(shown, ["2026-02-01 05:29:59", ""]);
  await east.context().close();
});

test("a picture is made small by the means of its blocks, also of those that its border cuts", async () => {
  const small = await page.evaluate(async () => {
    const { reduced } = await import("/pixels.js");
    const { image, mean } = await reduced({ width: 3, height: 3, channels: ["Y"], scale: 2,
      data: Float32Array.of(1, 3, 5, 5, 7, 9, 2, 4, 8) }, 2);
    return { size: [image.width, image.height], values: [...image.data], scale: image.scale, mean };
  });
  near(small.mean, 2 * 44 / 9);
  assert.deepEqual({ ...small, mean: null }, { size: [2, 2], values: [4, 7, 3, 8], scale: 2, mean: null });
});

test("zoom has a largest step, and ends with the whole picture", async () => {
  const [size, box] = [{ width: 100, height: 50 }, { width: 500, height: 500 }];
  const at = (zoom) => call("/viewport.js", "zoomTo", { zoom: null, x: 0.5, y: 0.5 }, size, box, zoom);
  assert.equal((await at(200)).zoom, 200);
  assert.equal((await at(1e6)).zoom, 256);
  assert.deepEqual(await at(0.5), { zoom: 1, x: 0.5, y: 0.5 });
  assert.deepEqual(await call("/viewport.js", "zoomTo", { zoom: 4, x: 0.1, y: 0.5 }, { width: 1000, height: 1000 }, box, 0.1),
    { zoom: null, x: 0.5, y: 0.5 });
});

test("render times are equal if their ratio is at most 1.05", async () => {
  const classOf = (times) => page.evaluate(async (all) => (await import("/curve.js")).aboutTimes(all).className, times);
  assert.equal(await classOf([100, 104]), "note");
  assert.equal(await classOf([100, 106]), "warning");
  assert.equal(await classOf([0.1, 0.5]), "warning");
  assert.equal(await classOf([7]), "note");
});

test("a job survives the shell: quotes in names are quoted", async () => {
  const line = await call("/api.js", "curlLine", "jobs", { scene: "it's \"here\"; $(rm)" });
  assert.ok(line.endsWith(`-d '{"scene":"it'\\''s \\"here\\"; $(rm)"}'`), line);
});

test("what a job leaves open is left out where it is posted again", async () => {
  const job = { scene: "a", budget: { seconds: 5, iterations: null }, layers: [], environment: null, seed: 0,
    exclusive: false, label: "" };
  assert.deepEqual(await call("/format.js", "withoutNulls", job),
    { scene: "a", budget: { seconds: 5 }, layers: [], seed: 0, exclusive: false, label: "" });
});

test("a job file is written with short lists on one line, and reads back the same", async () => {
  const job = { resolution: [8, 9], label: "[\n 1,\n 2\n]", layers: [], deep: { list: ["a", "b"] } };
  const text = await call("/format.js", "prettyJob", job);
  assert.match(text, /"resolution": \[8, 9\]/);
  assert.deepEqual(JSON.parse(text), job);
});

test("only settings that differ are listed, and those that change the picture are doubtful", async () => {
  const jobs = [{ scene: "a", seed: 1, budget: { seconds: 5 }, resolution: [2, 2] },
    { scene: "b", seed: 2, budget: { seconds: 5 }, resolution: [2, 2], extra: true }];
  const found = await call("/scaling.js", "differences", jobs);
  assert.deepEqual(found.map((d) => d.pointer), ["/scene", "/seed", "/extra"]);
  assert.deepEqual(await call("/scaling.js", "doubtful", found), ["/scene", "/extra"]);
});

test("what the page does not know of a job counts; only how it is estimated, and for whom, does not", async () => {
  const doubts = (a, b) => page.evaluate(async (jobs) => {
    const { differences, doubtful } = await import("/scaling.js");
    return doubtful(differences(jobs));
  }, [a, b]);
  const job = { scene: "a", label: "", integrator: { type: "path", max_depth: 6, roulette_depth: 6 },
    budget: { seconds: 5, error: null }, reference: "auto", environment: null, seed: 1, layers: [] };
  const other = { ...job, label: "b", integrator: { type: "bdpt", max_depth: 6, roulette_depth: 2, guide: { type: "bsdf" } },
    budget: { seconds: 6, error: { metric: "mse", target: 1 } }, seed: 2, layers: ["albedo"] };
  assert.deepEqual(await doubts(job, other), []);
  for (const [key, value] of Object.entries({ scene: "b", reference: "r.exr", unheard_of: 1 })) {
    assert.deepEqual(await doubts(job, { ...other, [key]: value }), [`/${key}`]);
  }
  assert.deepEqual(await doubts(job, { ...other, integrator: { ...other.integrator, max_depth: 7 } }),
    ["/integrator/max_depth"]);
  assert.deepEqual(await doubts(job, { ...other, unheard_of: { deep: { er: 1 } } }), ["/unheard_of/deep/er"]);
});

test("the page's pictures of errors are those of metrics that there are", async () => {
  const [kinds, metrics] = await page.evaluate(async () => [(await import("/errors.js")).errorKinds.map((k) => k.metric),
    (await import("/job_tables.js")).metrics.map((m) => m.key)]);
  assert.deepEqual(kinds.filter((key) => key && !metrics.includes(key)), []);
});

test("crops lie within the picture, in whole pixels", async () => {
  const size = { width: 300, height: 20 };
  assert.deepEqual(await call("/viewport.js", "settleCrop", null, size), { x: 148, y: 8, w: 5, h: 5 });
  assert.deepEqual(await call("/viewport.js", "cropBetween", { x: 310, y: -3 }, { x: 9.5, y: 4.2 }, size), { x: 9, y: 0, w: 256, h: 8 });
  assert.deepEqual(await call("/viewport.js", "movedCrop", { x: 290, y: 0, w: 8, h: 8 }, 1, -1, size), { x: 291, y: 0, w: 8, h: 8 });
});

test("a budget is doubled in every limit it has", async () => {
  const budget = { seconds: 30, iterations: null, error: { metric: "rmse", target: 0.02 } };
  assert.deepEqual(await call("/view_job.js", "doubled", budget), { seconds: 60, error: { metric: "rmse", target: 0.01 } });
});
