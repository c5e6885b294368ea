// What the tests of the page share: one browser a file; a fresh mock server and at most one page a
// test. Importing it sets this up; the names hold what there is at the moment.
import { after, afterEach, before, beforeEach } from "node:test";

import { launch, openPage } from "./browser.mjs";
import { Mock } from "./mock_server.mjs";

export let browser;
export let mock;
export let origin;
export let page;

before(async () => { browser = await launch(); });
after(() => browser.close());
beforeEach(async () => {
  mock = new Mock();
  origin = await mock.listen();
});
afterEach(async () => {
  await page?.context().close();
  page = undefined;
  mock.close();
});

/// Opens the page at `path` ("/#/..."); with openPage()'s options.
export async function open(path, options) {
  page = await openPage(browser, origin + path, options);
}
