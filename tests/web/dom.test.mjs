// Elements that are changed in place, addresses, and questions.
import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "./module_page.mjs";

test("elements with an id keep to it: they move with it, and stay the same ones", async () => {
  const seen = await page.evaluate(async () => {
    const { h, update } = await import("/dom.js");
    const list = h("ul");
    const show = (ids) => update(list, ids.map((id) => h("li", { id }, `item ${id}`)));
    show(["a", "b", "c"]);
    const [a, , c] = list.children;
    show(["c", "a", "d"]);
    return { texts: [...list.children].map((item) => item.textContent),
      same: list.children[0] === c && list.children[1] === a };
  });
  assert.deepEqual(seen, { texts: ["item c", "item a", "item d"], same: true });
});

test("what is being typed stays, what is not typed follows", async () => {
  const seen = await page.evaluate(async () => {
    const { h, update } = await import("/dom.js");
    const box = h("div");
    document.body.append(box);
    const show = (value, checked) => update(box, h("input", { value }), h("input", { type: "checkbox", checked }));
    show("1", false);
    const [text, check] = box.children;
    text.focus();
    text.value = "1.50";
    show("1.5", true);
    const typing = text.value;
    check.focus();
    show("1.5", false);
    const after = [text.value, check.checked];
    box.remove();
    return { typing, after };
  });
  assert.deepEqual(seen, { typing: "1.50", after: ["1.5", false] });
});

test("addresses keep their commas, and have no end without a query", async () => {
  const address = (values) => page.evaluate(async (given) => {
    const { addressOf } = await import("/dom.js");
    return addressOf(new URLSearchParams(given));
  }, values);
  assert.equal(await address({ jobs: "a,b", y: "rmse" }), "#/new?jobs=a,b&y=rmse");
  assert.equal(await address({}), "#/new");
});

test("only the agreeing answer is a yes; an action that fails is said, and the question stays", async () => {
  await page.evaluate(async () => {
    const { ask } = await import("/dom.js");
    window.asked = (act) => { window.answered = ask("Sure?", "Think.", "Agree", act); };
  });
  const question = page.locator("dialog");
  await page.evaluate(() => window.asked(() => { throw new Error("not now"); }));
  await question.getByRole("button", { name: "Agree" }).click();
  await question.getByText("not now").waitFor();
  await question.getByRole("button", { name: "Back" }).click();
  assert.equal(await page.evaluate(() => window.answered), false);
  await page.evaluate(() => window.asked());
  await page.keyboard.press("Escape");
  assert.equal(await page.evaluate(() => window.answered), false);
  await page.evaluate(() => window.asked());
  await question.getByRole("button", { name: "Agree" }).click();
  assert.equal(await page.evaluate(() => window.answered), true);
});
