// Posting a job: its file as text, the available scenes, and every problem with its position.
import { getJob, getScenes, postJob } from "./api.js";
import { append, h, problem, replace, select } from "./dom.js";
import { firstJob, prettyJob, withoutNulls } from "./format.js";

export async function show(main, { query, signal }) {
  document.title = "New job · Lacuna";
  const from = query.get("from");
  const [scenes, source] = await Promise.all([getScenes(signal), from ? getJob(from, signal) : null]);
  const start = source ? withoutNulls(source.job) : firstJob(scenes);

  const text = h("textarea",
    { id: "job", rows: 18, spellcheck: false, value: prettyJob(start), "aria-describedby": "errors" });
  const errors = h("div", { id: "errors", role: "alert" });
  const submit = h("button", { type: "submit" }, "Post the job");
  const scene = select(scenes.map((name) => ({ key: name, label: name })), start.scene, (name) => {
    try {
      text.value = prettyJob({ ...JSON.parse(text.value), scene: name });
    } catch {
      // Text that is not yet JSON is kept.
    }
  }, { id: "scene" });

  async function onsubmit(event) {
    event.preventDefault();
    submit.disabled = true;
    replace(errors);
    try {
      location.hash = `#/job/${await postJob(text.value)}`;
    } catch (error) {
      replace(errors, problem(`${error.title}. ${error.message}`),
        error.errors?.length > 0 && h("ul.errors", error.errors.map(({ pointer, message }) =>
          h("li", h("code", pointer || "(the document)"), " ", message))));
    }
    submit.disabled = false;
  }

  append(main, h("h1", "New job"), h("form.new-job", { onsubmit },
  h("p", h("label", { htmlFor: "scene" }, "Scene "), scene,
    scenes.length === 0 && h("span.problem", " the server has no scenes")),
  h("p", h("label", { htmlFor: "job" }, "Job file (JSON); missing keys have their defaults. "),
    h("a", { href: "/api/schema/job" }, "All keys and their allowed values")), text, errors, submit));
}
