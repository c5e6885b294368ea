// The report of a sweep: one file that needs no server (written by `lacuna report`).
import { answersView, summary } from "./answers.js";
import { aboutTimes } from "./curve.js";
import { h, note, replace } from "./dom.js";
import { seconds, when } from "./format.js";

const main = document.getElementById("main");
const { answers, crops, version, made } = JSON.parse(document.getElementById("data").textContent);

const figure = (src, alt, ...caption) => h("figure",
  h("img", { src, alt, loading: "lazy", decoding: "async" }), h("figcaption", caption.map((line) => h("span", line))));

function cropsOf(picture, cells, names) {
  const found = crops.find((c) => c.picture === picture);
  if (!found) return null;
  const [x, y, width, height] = found.rectangle;
  const shown = cells.map((cell) => [cell, found.cells.find((c) => c.cell === cell.cell)]).filter(([, c]) => c);
  return [
    h("h2", "The same part of each picture"),
    note(`${width} × ${height} pixels at (${x}, ${y}), where the cells' errors differ most, at one exposure, of each `
      + "cell's first seed."),
    shown.length > 0 && aboutTimes(shown.map(([, c]) => c.seconds)),
    h("div.crops", found.reference && figure(found.reference, "The reference", "reference"),
      shown.map(([cell, c]) => figure(c.src, names.get(cell.cell), names.get(cell.cell), seconds(c.seconds)))),
  ];
}

function show() {
  const query = new URLSearchParams(location.hash.split("?")[1]);
  const view = answersView(query, cropsOf);
  replace(main, h("h1", answers.label || "Sweep"), h("p", summary(answers)), view.element,
    note(`Made ${when(made)} by Lacuna ${version}.`));
  view.show(answers);
}

window.addEventListener("hashchange", show);
show();
