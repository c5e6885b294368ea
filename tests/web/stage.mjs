// What the tests of the page share: one browser, one page and one mock server a file, which each test
// finds as new. Importing it sets this up; the names hold what there is at the moment.
import { after, afterEach, before } from "node:test";

import { launch, newPage, visit } from "./browser.mjs";
import { Mock } from "./mock_server.mjs";

export const mock = new Mock();
export let browser;
export let origin;
export let page;

before(async () => {
  origin = await mock.listen();
  browser = await launch();
});
after(async () => {
  await browser.close();
  mock.close();
});
afterEach(async () => {
  mock.reset();
  if (!mock.server.listening) await mock.listen(new URL(origin).port);
  if (page === undefined || page.isClosed()) return;
  await page.goto("about:blank");
  await page.context().clearCookies();
});

/// Opens the page at `path` ("/#/..."). It is the same from test to test, because its modules then come
/// from the browser's cache; a test that leaves something behind in it closes it.
export async function open(path, { viewport = { width: 1280, height: 900 }, colorScheme = "light" } = {}) {
  if (page === undefined || page.isClosed()) page = await newPage(browser);
  await page.setViewportSize(viewport);
  await page.emulateMedia({ colorScheme });
  await visit(page, origin + path);
}
