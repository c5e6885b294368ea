// The list of jobs, what can be done to a job, and the token, against the mock server.
import assert from "node:assert/strict";
import { test } from "node:test";

import { frames, longestTask, newPage, ready, screenshot, visit } from "./browser.mjs";
import { manyJobs, progress } from "./fixtures.mjs";
import { browser, mock, open, origin, page } from "./stage.mjs";

const running = "20260131-101900-running";
const waiting = "20260131-101800-waiting";
const evil = "20260131-101700-hostile";
const stopped = "20260131-101600-stopped";
const shallow = "20260131-101500-shallow";
const cornell = "20260131-101400-cornell";

const text = (selector) => page.locator(selector).first().innerText();
const rows = () => page.locator("tr[data-job]").evaluateAll((all) => all.map((r) => r.dataset.job));
const rowCount = (n) => page.waitForFunction((m) => document.querySelectorAll("tr[data-job]").length === m, n);
const counted = (words) => page.waitForFunction((t) => document.querySelector("main > .tools output").textContent === t, words);
const button = (name) => page.getByRole("button", { name, exact: true });
const stateIs = (state) => page.waitForSelector(`article[data-state=${state}]`);
/// The asking window's button; it closes by the answer.
const answer = async (name) => {
  await page.locator("dialog").getByRole("button", { name }).click();
  await page.waitForSelector("dialog", { state: "detached" });
};

test("the list shows every job, newest first, with pictures only where there are any", async () => {
  await open("/");
  assert.deepEqual(await rows(), mock.jobs.map((job) => job.id));
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length === 3);
  assert.match(await text(`tr[data-job="${running}"] .progress`), /^10 %, 27 s left$/);
  assert.equal(await text(`tr[data-job="${cornell}"] .error`), "rmse 0.0138");
  assert.equal(await text(`tr[data-job="${evil}"] .badge`), "failed");
});

test("a running job's picture is asked for once there is one, however far the job is", async () => {
  const files = { ...mock.find(running).files };
  delete mock.find(running).files["image.png"];
  await open("/");
  await page.waitForFunction(() => document.querySelectorAll(".thumb img").length === 2);
  const thumb = page.locator(`tr[data-job="${running}"] .thumb img`);
  assert.equal(await thumb.count(), 0);
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  mock.update(running, { progress: progress(6, 0.15) });
  await page.waitForFunction((id) => document.querySelector(`tr[data-job="${id}"] progress`).value === 0.15, running);
  mock.update(running, { files, progress: progress(8, 0.2) });
  await thumb.waitFor();
  assert.equal(mock.requests.filter((r) => r.includes(`${running}/files/image.png`)).length, 1);
  assert.deepEqual(page.troubles, []);
});

test("one stream of events moves the list: progress, states, jobs that come and go", async () => {
  await open("/");
  const bar = page.locator(`tr[data-job="${running}"] progress`);
  assert.equal(await bar.evaluate((b) => b.value), 0.1);
  const asked = () => mock.requests.filter((r) => r === "GET /api/jobs").length;
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  const before = asked();
  mock.update(running, { progress: progress(20, 0.5) });
  await page.waitForFunction((id) => document.querySelector(`tr[data-job="${id}"] progress`).value === 0.5, running);
  assert.equal(asked(), before, "progress needs no other request");
  mock.add({ ...mock.find(waiting), id: "20260131-102000-newest" });
  await rowCount(7);
  assert.equal((await rows())[0], "20260131-102000-newest");
  mock.update(running, { state: { state: "held", phase: "" } });
  await page.waitForFunction(() => document.querySelector("select").innerText.includes("held (1)"));
  assert.equal(await text(`tr[data-job="${running}"] .badge`), "held");
  mock.drop(waiting);
  await rowCount(6);
  mock.jobs.splice(0, 1);
  mock.event(null, "reset", {});
  await rowCount(5);
  assert.equal(mock.listeners.size, 1);
  assert.deepEqual(page.troubles, []);
});

test("where no events can be had, the list asks", async () => {
  mock.events = false;
  await open("/");
  mock.update(running, { progress: progress(20, 0.5) });
  await page.waitForFunction((id) => document.querySelector(`tr[data-job="${id}"] progress`).value === 0.5, running);
});

/// The page's second question for the list gets no answer.
async function loseSecondList(t) {
  await open("/#/new");
  let asked = 0;
  const list = (url) => url.pathname === "/api/jobs";
  await page.route(list, (route) => {
    asked += 1;
    return asked === 2 ? route.abort() : route.continue();
  });
  t.after(() => page.unroute(list));
}

test("a service that refuses its events and then does not answer is asked again", async (t) => {
  mock.events = false;
  await loseSecondList(t);
  await open("/");
  await page.getByText("The server does not answer; trying again.").waitFor();
  mock.drop(waiting);
  await rowCount(5);
  await page.getByText("The server does not answer; trying again.").waitFor({ state: "detached" });
});

test("a list that is not answered after an event is asked for again", async (t) => {
  await loseSecondList(t);
  await open("/");
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  mock.drop(waiting);
  await page.getByText("The server does not answer; trying again.").waitFor();
  await rowCount(5);
  await page.getByText("The server does not answer; trying again.").waitFor({ state: "detached" });
});

test("a job that waits for a fault to pass says so, in the list, above it and on its own page", async () => {
  const full = "renderer could not write its files: No space left on device";
  const reason = page.locator(`tr[data-job="${waiting}"] .reason`);
  await open("/");
  assert.equal(await reason.innerText(), "");
  assert.equal(await page.locator("main .warning").count(), 0);
  mock.obstacle = "renderers cannot write their files";
  mock.update(waiting, { state: { obstacle: full } });
  await page.waitForFunction(([id, words]) => document.querySelector(`tr[data-job="${id}"] .reason`).innerText === words,
    [waiting, full]);
  await page.getByText("Jobs wait: renderers cannot write their files").waitFor();
  assert.equal(await text(`tr[data-job="${waiting}"] .badge`), "queued", "it has not failed");
  await open(`/#/job/${waiting}`);
  await page.getByText(`Waiting: ${full}`).waitFor();
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  mock.obstacle = "";
  mock.update(waiting, { state: { obstacle: "", place: "Slurm job 17 waits: Resources" } });
  await page.getByText("Slurm job 17 waits: Resources").waitFor();
  await page.getByText("Waiting:").waitFor({ state: "detached" });
  await open("/");
  await page.getByText("Jobs wait:").waitFor({ state: "detached" });
  assert.equal(await reason.innerText(), "");
  assert.deepEqual(page.troubles, []);
});

test("the filter and the state are the service's, and go into the address", async () => {
  await open("/");
  await page.fill("input[type=search]", "CORNELL box");
  await counted("2 of 6");
  assert.ok(page.url().endsWith("#/?label=CORNELL+box"), page.url());
  await page.reload();
  await ready(page);
  assert.deepEqual(await rows(), [shallow, cornell]);
  const state = page.getByLabel("State", { exact: true });
  assert.ok((await state.innerText()).includes("done (2)"));
  await state.selectOption("failed");
  await counted("0 of 6");
  await page.getByText("No job matches the filter.").waitFor();
  await page.fill("input[type=search]", "");
  await counted("1 of 6");
  assert.ok(page.url().endsWith("#/?state=failed"));
  assert.deepEqual(page.troubles, []);
});

test("ten thousand jobs: pages by cursor, a choice that survives them, and no pause", async () => {
  mock.jobs = manyJobs(10000);
  await page?.computed();
  const began = performance.now();
  await open("/");
  await rowCount(100);
  const shown = performance.now() - began;
  const loading = await longestTask(page, true);
  const busyLoading = await page.computed();
  assert.equal(await text(".pager output"), "1–100 of 10000");
  const check = (n) => page.locator("tr[data-job] input").nth(n).check();
  await check(3);
  await button("Older ›").click();
  await page.waitForFunction(() => document.querySelector(".pager output")?.textContent.startsWith("101–200"));
  assert.equal(await text("tr[data-job] .name a"), "job 100");
  await check(4);
  assert.equal(await button("Compare (2)").isEnabled(), true);
  await button("Older ›").click();
  await page.waitForFunction(() => document.querySelector(".pager output")?.textContent.startsWith("201–300"));
  await page.reload();
  await ready(page);
  assert.equal(await text("tr[data-job] .name a"), "job 200", "the address holds the page");
  await page.goto(`${origin}/#/`);
  await page.waitForFunction(() => document.querySelector(".pager output")?.textContent.startsWith("1–100"));
  await check(3);
  await button("Older ›").click();
  await page.waitForFunction(() => document.querySelector(".pager output")?.textContent.startsWith("101–200"));
  await button("‹ Newer").click();
  await page.waitForFunction(() => document.querySelector(".pager output")?.textContent.startsWith("1–100"));
  assert.equal(await page.locator("tr[data-job] input:checked").count(), 1, "the choice is still seen");
  await longestTask(page, true);
  await page.computed();
  await page.fill("input[type=search]", "job 77");
  await counted("111 of 10000");
  const filtering = await longestTask(page);
  const busy = await page.computed();
  console.log(`# 10,000 jobs: first rows ${shown.toFixed(0)} ms after the browser was asked; longest task ${loading} ms `
    + `while loading, ${filtering} ms while filtering (0: none above 50), for which the page computed ${busyLoading} ms and ${busy} ms`);
  assert.ok(Math.max(busyLoading, busy) < 1000);
  const details = mock.requests.filter((r) => /GET \/api\/jobs\/[^/]+$/.test(r)).length;
  assert.equal(details, 0, "the list needs no job's details");
  await screenshot(page, "jobs-many");
  assert.deepEqual(page.troubles, []);
});

test("jobs chosen in the list are compared; the choice is kept, and cleared", async () => {
  await open("/");
  assert.equal(await button("Compare").isDisabled(), true);
  for (const id of [cornell, shallow]) await page.check(`tr[data-job="${id}"] input`);
  await button("Compare (2)").click();
  await page.waitForSelector(".plot[data-curves='2']");
  assert.ok(page.url().endsWith(`#/compare?jobs=${cornell},${shallow}`));
  await page.goBack();
  await page.waitForSelector(`tr[data-job="${cornell}"] input:checked`);
  await button("Clear the selection").click();
  await page.waitForFunction(() => document.querySelectorAll("tr[data-job] input:checked").length === 0);
  assert.equal(await button("Compare").isDisabled(), true);
});

test("a job that is removed is no longer chosen, also where no row of it is shown", async () => {
  await open("/");
  for (const id of [cornell, shallow, evil]) await page.check(`tr[data-job="${id}"] input`);
  await button("Compare (3)").waitFor();
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  mock.drop(shallow);
  await button("Compare (2)").waitFor();
  await page.fill("input[type=search]", "nothing has this name");
  await counted("0 of 5");
  mock.drop(evil);
  await button("Compare (1)").waitFor();
  assert.equal(await button("Compare (1)").isDisabled(), true);
  await page.reload();  // the choice goes with the page
});

test("an answer to an earlier filter that comes late does not replace the list", async (t) => {
  mock.events = false;  // then the list is polled, beside what the filter asks for
  await open("/");
  const answer = mock.answer.bind(mock);
  let held = null;
  mock.answer = (request, response) => {
    const url = new URL(request.url, "http://mock");
    if (held !== null || url.pathname !== "/api/jobs" || url.searchParams.has("label")) return answer(request, response);
    held = () => answer(request, response);
    return Promise.resolve();
  };
  t.after(() => { delete mock.answer; });
  while (held === null) await page.waitForTimeout(20);
  await page.fill("input[type=search]", "cornell");
  await counted("3 of 6");
  const late = page.waitForResponse((response) => response.url().endsWith("/api/jobs?limit=100"));
  await held();
  await (await late).finished();
  await frames(page);
  assert.equal(await text("main > .tools output"), "3 of 6");
  assert.equal((await rows()).includes(running), false);
});

test("an empty list says how to post the first job, and sees it come", async () => {
  const [job] = mock.jobs;
  mock.jobs = [];
  await open("/");
  assert.match(await text(".empty pre"), new RegExp(`^curl .*${origin}/api/jobs`));
  await screenshot(page, "empty");
  while (mock.listeners.size === 0) await page.waitForTimeout(20);
  mock.add(job);
  await rowCount(1);
  assert.deepEqual(page.troubles, []);
});

test("a server that goes away and comes back is said and forgotten", async () => {
  await open("/");
  const { port } = mock.server.address();
  mock.close();
  await page.getByText("The server does not answer; trying again.").waitFor();
  assert.equal((await rows()).length, 6);
  await mock.listen(port);
  await page.getByText("The server does not answer; trying again.").waitFor({ state: "detached" });
});

test("a job's buttons are those that its state allows", async () => {
  const shown = () => page.locator(".actions button:visible").allInnerTexts();
  const waits = ["−", "+", "Hold", "Cancel job"];
  const expected = { [running]: waits, [waiting]: waits, [stopped]: ["Retry", "Extend …", "Delete …"],
    [evil]: ["Retry", "Extend …", "Delete …"], [cornell]: ["Extend …", "Delete …"] };
  await open("/");
  for (const [id, names] of Object.entries(expected)) {
    await page.goto(`${origin}/#/job/${id}`);
    await page.waitForFunction((i) => document.querySelector("p.id")?.textContent === i, id);
    assert.deepEqual(await shown(), names, id);
  }
  assert.deepEqual(page.troubles, []);
});

test("what may be done to a job is what the service says, and so are the states to choose from", async () => {
  mock.states = [...mock.states, { name: "resting", terminal: false, actions: ["retry"] }]
    .map((state) => (state.name === "done" ? { ...state, actions: ["cancel"] } : state));
  mock.find(running).state.state = "resting";
  await open("/");
  assert.ok((await page.getByLabel("State", { exact: true }).innerText()).includes("resting (1)"));
  for (const [id, name] of [[running, "Retry"], [cornell, "Cancel job"]]) {
    await page.goto(`${origin}/#/job/${id}`);
    await page.waitForFunction((i) => document.querySelector("p.id")?.textContent === i, id);
    assert.deepEqual(await page.locator(".actions button:visible").allInnerTexts(), [name]);
  }
  assert.deepEqual(page.troubles, []);
});

test("the first view takes at most twelve requests, beside the jobs' pictures", async (t) => {
  for (const jobs of [mock.jobs, []]) {
    mock.jobs = jobs;
    const fresh = await newPage(browser);
    t.after(() => fresh.context().close());
    const asked = [];
    fresh.on("request", (request) => asked.push(new URL(request.url()).pathname));
    await visit(fresh, `${origin}/#/`);
    while (![...mock.listeners].some(({ id }) => id === null)) await fresh.waitForTimeout(20);
    const own = asked.filter((path) => path.startsWith("/") && !path.endsWith("/image.png"));
    assert.ok(own.length <= 12, own.join(" "));
    assert.equal(new Set(own).size, own.length, "nothing is asked for twice");
    assert.ok(own.includes("/api/states") && own.includes("/api/events"), own.join(" "));
    assert.deepEqual(fresh.troubles, []);
    mock.reset();
  }
});

test("a job is held, released, put forward and cancelled", async () => {
  await open(`/#/job/${running}`);
  await button("Hold").click();
  await stateIs("held");
  assert.equal(mock.find(running).held, true);
  await screenshot(page, "held");
  await button("Release").click();
  await stateIs("queued");
  await button("Higher priority").click();
  await page.getByText("priority 1").waitFor();
  assert.equal(mock.find(running).priority, 1);
  await button("Cancel job").click();
  await page.locator("dialog").waitFor();
  await screenshot(page, "ask");
  await answer("Back");
  assert.equal(mock.find(running).state.state, "queued");
  await button("Cancel job").click();
  await answer("Cancel job");
  await stateIs("cancelled");
  await button("Retry").click();
  await stateIs("queued");
  mock.update(running, { state: { state: "running", phase: "rendering" }, progress: progress(8, 0.3) });
  await page.waitForFunction(() => document.querySelector(".title progress").value === 0.3);
  assert.deepEqual(page.troubles, []);
});

test("a done job gets a larger budget; what the service refuses is said, and the question stays", async () => {
  await open(`/#/job/${cornell}`);
  await button("Extend …").click();
  const field = page.getByRole("textbox", { name: "Budget" });
  assert.equal(await field.inputValue(), "{\"seconds\":60}");
  await field.fill("{\"seconds\":10}");
  await button("Extend").click();
  await page.getByText("/budget/seconds: found 10, allowed: 30 or more").waitFor();
  await field.fill("{\"seconds\":60}");
  await answer("Extend");
  await stateIs("queued");
  await page.getByText("\"seconds\": 60").waitFor();
  while (![...mock.listeners].some((l) => l.id === cornell)) await page.waitForTimeout(20);
  mock.update(cornell, { state: { state: "running" }, progress: progress(1100, 0.6) });
  await page.waitForFunction(() => document.querySelector(".title progress").value === 0.6);
  assert.deepEqual(page.troubles.filter((t) => !/status of 400/.test(t)), []);
});

test("a job is deleted only after a question, and a refusal is said in words", async () => {
  await open(`/#/job/${stopped}`);
  mock.find(stopped).state.state = "running";  // behind the page's back
  await button("Delete …").click();
  await button("Delete for good").click();
  await page.getByText("The job is running.").waitFor();
  await answer("Back");
  mock.find(stopped).state.state = "cancelled";
  await button("Delete …").click();
  await button("Delete for good").click();
  await rowCount(5);
  assert.ok(!(await rows()).includes(stopped));
});

test("a service with a token asks for it once, and the page goes on where it was", async () => {
  await open("/#/new");
  mock.token = "open sesame";
  await page.goto(`${origin}/#/job/${cornell}`);
  await page.getByRole("textbox", { name: "Token" }).fill("wrong");
  await button("Continue").click();
  await page.getByText("That is not the token.").waitFor();
  await screenshot(page, "token");
  await page.getByRole("textbox", { name: "Token" }).fill(mock.token);
  await button("Continue").click();
  await page.getByRole("heading", { name: "Cornell box, 6 edges" }).waitFor();
  await page.waitForSelector(".stage[data-shown]");
  assert.equal(await page.locator("dialog").count(), 0);
});
