// The sweeps, newest first.
import { poll } from "./api.js";
import { copyButton, h, replace, table } from "./dom.js";
import { number, when } from "./format.js";
import { badge, progressBar } from "./status.js";
import { getSweeps, sweepCurl } from "./sweeps_api.js";

const everyMs = 2000;

const first = {
  label: "next event estimation",
  job: { scene: "SCENE.glb", budget: { seconds: 10 }, reference: "auto" },
  axes: { "/integrator/next_event_estimation": [true, false], "/integrator/max_depth": [4, 8] },
  seeds: 3, baseline: { "/integrator/next_event_estimation": false },
};

function none() {
  const command = sweepCurl(first);
  return h("section.empty", h("h2", "No sweeps yet"),
    h("p", "A sweep is many jobs that differ in some settings. Post one from a shell:"),
    h("pre", { tabIndex: 0 }, command), copyButton(() => command));
}

function row(sweep) {
  const state = badge();
  state.set(sweep.state);
  const bar = progressBar("Share of the runs");
  if (sweep.state === "running") bar.set("running", { share: sweep.share, remaining_seconds: null });
  const { failed = 0, done = 0 } = sweep.counts;
  return [
    h("a", { href: `#/sweep/${sweep.id}` }, sweep.label || sweep.id), state.element, bar.element,
    `${number(done)} of ${number(sweep.run_count)}`, failed > 0 ? h("span.failed", number(failed)) : "0",
    when(sweep.created),
  ];
}

export async function show(main, { signal }) {
  document.title = "Sweeps · Lacuna";
  const body = h("div");
  main.append(h("h1", "Sweeps"), body);
  await poll(async () => {
    const sweeps = await getSweeps(signal);
    replace(body, sweeps.length === 0 ? none()
      : table(["Sweep", "State", "", "Runs done", "Failed", "Created"], sweeps.map(row)));
  }, everyMs, signal);
}
