// The curves of one or more jobs as a single figure, to be saved or shown elsewhere.
import { curvePanel } from "./curve_panel.js";
import { h, problem, replace } from "./dom.js";
import { followJobs, idsOf } from "./series.js";

export async function show(main, { params, query, signal }) {
  document.title = "Figure · Lacuna";
  const panel = curvePanel(query, signal);
  const notes = h("div");
  main.append(notes, panel.element);
  await followJobs(params.id ? [params.id] : idsOf(query), ({ series, preferred, problems }) => {
    replace(notes, problems.map(problem));
    panel.show(series, preferred);
  }, signal);
}
