// Which settings give which error in which time, and how sure that is: a sweep's answers, as the page and
// the report show them.
import { bandPoints, cellNames, charges, count, frontParts, settingNames } from "./answers.js";
import { answersTable, tables } from "./answers_table.js";
import { bandFigure } from "./band_figure.js";
import { axes } from "./curve.js";
import { h, labelledSelect, note, replace, warning } from "./dom.js";
import { metrics } from "./job_tables.js";
import { colours } from "./palette.js";

const narrowest = 280;

/// The cells that are shown at first: those of the front and their baselines.
function natural(picture, cells) {
  const leading = [...picture.front.render, ...picture.front.cold].map((part) => part.cell);
  const all = leading.flatMap((n) => [n, cells.find((c) => c.cell === n)?.baseline]);
  return [...new Set(all.filter(Boolean))].slice(0, colours);
}

/// The answers with their switches. `query` (URLSearchParams) holds every choice; `remember()` is called
/// after it changed. `pictures(picture, cells, names)` gives an element for the chosen cells' pictures, or
/// null. `show(answers)` draws anew.
export function answersView(query, remember, pictures) {
  const warnings = h("div");
  const front = h("section");
  const figure = h("div.plot");
  const table = h("div");
  const crops = h("section");
  const several = note("Only cells that estimate the same picture are compared: of one scene, camera and resolution, "
    + "against one reference.");
  const choose = (key) => (value) => {
    query.set(key, value);
    remember();
    draw();
  };
  const whichPicture = labelledSelect("Picture", (value) => {
    query.delete("cells");
    choose("picture")(value);
  });
  const charge = labelledSelect("Time", choose("charge"));
  const which = labelledSelect("Table", choose("table"));
  let answers = null;
  let width = 0;

  /// One of `options` by its key in the query, else the first.
  const picked = (options, key) => options.find((o) => o.key === query.get(key)) ?? options[0];

  function chosenCells(picture, cells) {
    if (!query.has("cells")) return natural(picture, cells);
    return query.get("cells").split(",").map(Number).filter((n) => picture.cells.includes(n));
  }

  function drawFigure(parts) {
    if (width === 0) return;
    const svg = bandFigure(parts.curves, parts.chosen, parts.front, parts.axis, parts.metric,
      Math.max(narrowest, width));
    figure.replaceChildren(svg ?? note("No run is done yet."));
    figure.dataset.cells = parts.curves.filter((c) => c.curve.length > 0).length;
  }

  function drawFront(picture, names, how) {
    const parts = frontParts(picture.front[how.key], names);
    replace(front, h("h2", "Lowest error"), parts.length === 0
      ? note(how.key === "render" ? "No run is done yet." : "No run measured its preparation.")
      : h("ol.front", parts.map((part) => h("li", `${part.text}: `, h("strong", part.name),
        part.doubts && h("span.muted", ` (${part.doubts})`)))));
  }

  function drawTable(picture, cells, chosen) {
    const on = new Set(chosen);
    replace(table, answersTable({ answers, picture, cells, which: picked(tables, "table").key, query, chosen: on,
      onsort: choose("sort"),
      onchoose(cell, ticked) {
        if (ticked) on.add(cell);
        else on.delete(cell);
        choose("cells")([...on].join(","));
      } }));
  }

  let last = null;
  function draw() {
    if (!answers) return;
    const options = answers.pictures.map((p, i) => ({ key: String(i + 1), label: p.text || "all cells" }));
    const number = Number(picked(options, "picture").key);
    const picture = answers.pictures[number - 1];
    const cells = picture.cells.map((n) => answers.cells[n - 1]);
    const names = cellNames(answers, cells);
    const how = picked(charges, "charge");
    const chosen = chosenCells(picture, cells);
    whichPicture.fill(options, String(number));
    for (const part of [whichPicture.element, several]) part.hidden = options.length < 2;
    charge.fill(charges, how.key);
    which.fill(tables, picked(tables, "table").key);
    replace(warnings, answers.warnings.map(warning));
    drawFront(picture, names, how);
    last = {
      curves: cells.map((c) => ({ cell: c.cell, name: names.get(c.cell), curve: bandPoints(c, how.key) })),
      chosen, front: picture.front[how.key],
      axis: { label: `${axes.find((a) => a.key === answers.clock).label}, ${how.label}`, unit: "s" },
      metric: metrics.find((m) => m.key === answers.metric),
    };
    drawFigure(last);
    drawTable(picture, cells, chosen);
    const shown = chosen.map((n) => answers.cells[n - 1]);
    replace(crops, pictures(number, shown, names));
  }

  new ResizeObserver(([entry]) => {
    const now = Math.floor(entry.contentRect.width);
    if (now === width) return;
    width = now;
    if (last) drawFigure(last);
  }).observe(figure);

  return {
    element: h("div.answers", warnings, h("div.switches", whichPicture.element, charge.element), several,
      front, h("figure", figure),
      h("h2", "All cells"), h("div.switches", which.element), table,
      note("Means are geometric, over the seeds; in parentheses 95 % intervals (Student's t of the logarithms, "
        + "Welch's for ratios). A ratio whose interval contains 1 is not significant."), crops),
    show(next) {
      answers = next;
      draw();
    },
  };
}

/// "9 cells of integrator/guide and resolution, 3 seeds: 27 of 27 runs done".
export function summary(answers) {
  const runs = Object.values(answers.states).reduce((sum, n) => sum + n, 0);
  const names = settingNames(answers.settings).join(", ");
  return `${count(answers.cells.length, "cell")}${names && ` of ${names}`}, ${count(answers.seeds, "seed")}: `
    + `${answers.states.done ?? 0} of ${count(runs, "run")} done`;
}
