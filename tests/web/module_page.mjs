// One page of the application for all tests of a file, in which they call its modules.
import { after, before } from "node:test";

import { launch, openPage } from "./browser.mjs";
import { Mock } from "./mock_server.mjs";

/// Both are open while the tests of the file run.
export let browser;
export let page;
let mock;

before(async () => {
  browser = await launch();
  mock = new Mock();
  page = await openPage(browser, `${await mock.listen()}/#/new`);
});
after(async () => {
  await browser.close();
  mock.close();
});

/// What a function of a module returns for some arguments.
export const call = (module, name, ...given) => page.evaluate(
  async ([m, n, args]) => (await import(m))[n](...args), [module, name, given]);
