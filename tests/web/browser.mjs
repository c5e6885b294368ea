// Chromium for the tests, and pages that remember what went wrong in them.
import { mkdir } from "node:fs/promises";
import { join } from "node:path";

import { chromium } from "playwright-core";

// Without the watchdog, which takes the page's graphics away where the machine is busy.
const args = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--enable-unsafe-swiftshader", "--disable-gpu-watchdog", "--disable-gpu-process-crash-limit",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const launch = () => chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args,
});

/// What the software renderer says when a picture of the page is taken, and the browser when the machine takes
/// a graphics context away, which the page must live with.
const noise = /GL Driver Message.*GPU stall due to ReadPixels|CONTEXT_LOST_WEBGL/;

/// Runs in the page before its own modules: remembers every graphics context, also those of canvases that are
/// nowhere in the document.
function rememberGraphics() {
  window.graphics = new Set();
  for (const { prototype } of [HTMLCanvasElement, OffscreenCanvas]) {
    const get = prototype.getContext;
    prototype.getContext = function getContext(kind, ...more) {
      const context = get.call(this, kind, ...more);
      if (kind === "webgl2" && context) window.graphics.add(context);
      return context;
    };
  }
}

/// A message of the console, with the address it is about where it does not say it.
function told(message) {
  const { url } = message.location();
  return url.startsWith("http") ? `${message.text()} (${url})` : message.text();
}

/// A function that gives for how many ms the page's own thread has computed since it was last asked: a time that
/// other work of a busy machine adds nothing to.
async function computingTime(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  let before = 0;
  return async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    const now = 1000 * metrics.find((m) => m.name === "TaskDuration").value;
    const passed = now - before;
    before = now;
    return Math.round(passed);
  };
}

/// A page in a fresh context with `options`, or in `context`. `page.troubles` collects console errors
/// and warnings, exceptions, and requests to other hosts than that of the last visit(); `page.computed` is
/// its computingTime().
export async function newPage(browser, { context = null, ...options } = {}) {
  const own = context ?? await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await own.newPage();
  await page.addInitScript(rememberGraphics);
  await page.addInitScript(() => {
    window.longTasks = [];
    new PerformanceObserver((list) => window.longTasks.push(...list.getEntries().map((task) => task.duration)))
      .observe({ type: "longtask", buffered: true });
  });
  page.computed = await computingTime(page);
  page.troubles = [];
  page.on("console", (message) => {
    const counts = ["error", "warning"].includes(message.type()) && !noise.test(message.text());
    if (counts) page.troubles.push(told(message));
  });
  page.on("pageerror", (error) => page.troubles.push(String(error)));
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.host !== page.home && !["about:", "data:", "blob:"].includes(url.protocol)) {
      page.troubles.push(`a request to ${url.host}`);
    }
  });
  return page;
}

/// Loads `address`, and with `wait` waits until it is ready to look at. Earlier troubles are forgotten.
export async function visit(page, address, wait = true) {
  page.troubles = [];
  page.home = new URL(address).host;
  await page.goto(address);
  if (wait) await ready(page);
}

/// A new page at `address`; see newPage() and visit().
export async function openPage(browser, address, { wait = true, ...options } = {}) {
  const page = await newPage(browser, options);
  await visit(page, address, wait);
  return page;
}

/// The longest time in ms that one task has kept the page busy, of those above 50 ms; 0: there was none.
/// With `anew`, only what comes later counts the next time.
export const longestTask = (page, anew = false) => page.evaluate(async (forget) => {
  await new Promise((resolve) => { setTimeout(resolve, 100); });
  const longest = Math.max(0, ...window.longTasks);
  if (forget) window.longTasks = [];
  return Math.round(longest);
}, anew);

/// Waits until the router has shown the view.
export const ready = (page) => page.waitForSelector("main[data-ready]");

/// Waits until what was asked for has been drawn.
export const frames = (page) => page.evaluate(() => new Promise((resolve) => {
  requestAnimationFrame(() => requestAnimationFrame(resolve));
}));

/// Writes a picture of the whole page to $LACUNA_SCREENSHOTS, if that is set.
export async function screenshot(page, name) {
  const folder = process.env.LACUNA_SCREENSHOTS;
  if (!folder) return;
  await mkdir(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
}

/// Takes every graphics context from the page, as a machine may, and waits until the page knows.
export const takeGraphics = (page) => page.evaluate(async () => {
  const all = [...window.graphics].filter((gl) => !gl.isContextLost());
  window.taken = all.map((gl) => ({ gl, extension: gl.getExtension("WEBGL_lose_context") }));
  await Promise.all(window.taken.map(({ gl, extension }) => new Promise((resolve) => {
    gl.canvas.addEventListener("webglcontextlost", () => setTimeout(resolve), { once: true });
    extension.loseContext();
  })));
  return all.length;
});

/// Gives them back; a page that did not ask for them never gets them.
export const giveGraphicsBack = (page) => page.evaluate(() => Promise.all(
  window.taken.map(({ gl, extension }) => new Promise((resolve, reject) => {
    gl.canvas.addEventListener("webglcontextrestored", () => resolve(), { once: true });
    extension.restoreContext();
    setTimeout(() => reject(new Error("the page did not ask for its graphics")), 30_000);
  })),
));

/// Calls `check` until nothing that it asserts is wrong: what the screen shows comes late where the machine is
/// busy, or has just taken the graphics away.
export async function eventually(check, ms = 30_000) {
  const end = Date.now() + ms;
  for (;;) {
    try {
      return await check();
    } catch (error) {
      if (error.code !== "ERR_ASSERTION" || Date.now() > end) throw error;
    }
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
}

/// The colours, [r, g, b] in bytes, that the screen shows at `points` ([{u, v}], in CSS pixels) of an
/// element.
export async function coloursOf(page, selector, points) {
  const bytes = await page.locator(selector).screenshot();
  return page.evaluate(async ([source, places]) => {
    const image = new Image();
    image.src = `data:image/png;base64,${source}`;
    await image.decode();
    const context = Object.assign(document.createElement("canvas"),
      { width: image.width, height: image.height }).getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return places.map(({ u, v }) => [...context.getImageData(u, v, 1, 1).data].slice(0, 3));
  }, [bytes.toString("base64"), points]);
}
