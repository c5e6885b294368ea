// The dialog of a figure of a paper, which the service draws (docs/figures.md), and the file that makes it at a shell.
import { drawFigure } from "./api.js";
import { action, ask, button, copyButton, h, note, problem, replace, save } from "./dom.js";
import { prettyJob } from "./format.js";

/// `spec`: the figure's file.
export function showFigure(spec) {
  const text = prettyJob(spec);
  const trouble = h("div", { role: "status" });
  const say = (message) => replace(trouble, message && problem(message));
  const draw = (format) => button(format.toUpperCase(), action(() => {
    replace(trouble, note("Being drawn …"));
    return drawFigure(text, format).then((figure) => save(figure, `figure.${format}`));
  }, () => say(""), say));
  return ask("Figure", [
    h("div.tools", ["pdf", "svg", "png"].map(draw)), trouble,
    note("Its file, and the command that draws it from the service's data folder:"),
    h("pre.tall", { tabIndex: 0 }, text), h("pre", "LACUNA_DATA=DATA lacuna figure figure.json -o figure.pdf"),
    h("div.tools", copyButton(text),
      button("Save figure.json", () => save(new Blob([`${text}\n`], { type: "application/json" }), "figure.json"))),
  ]);
}
