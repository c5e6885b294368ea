// Where a job's time and rays went, and what it built, from report.json.
import { facts, h } from "./dom.js";
import { number, quantity, seconds, words } from "./format.js";
import { curveColour } from "./palette.js";
import { leafName, leaves } from "./report.js";

/// Shares of a whole as one bar, with a legend that says the same in words; `parts` are [{name, value, text}].
function stackedBar(title, parts) {
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  const percent = ({ value }) => (total > 0 ? (100 * value) / total : 0);
  const paint = (element, i) => {
    element.style.background = curveColour(i);
    return element;
  };
  const pieces = parts.map((part, i) => {
    const piece = paint(h("span", { title: `${part.name}: ${part.text}` }), i);
    piece.style.width = `${percent(part)}%`;
    return piece;
  });
  const entries = parts.map((part, i) => h("li", paint(h("span.swatch"), i),
    `${part.name} `, h("span.muted", `${part.text}, ${percent(part).toFixed(1)} %`)));
  return h("section.stacked", h("h3", title),
    h("div.stacked-bar", { "aria-hidden": "true" }, pieces), h("ul", entries));
}

/// A bar of the numbers in `object` whose name `belongs`, the largest first.
function bar(title, object, show, belongs) {
  const parts = leaves(object ?? {})
    .map(({ keys, value }) => ({ name: leafName(keys), value, text: show(value) }))
    .filter(({ name, value }) => typeof value === "number" && belongs(name)).sort((a, b) => b.value - a.value);
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  return parts.length > 0 && stackedBar(`${title}: ${show(total)} in all`, parts);
}

/// An artefact is a name, or {name, seconds, bytes, ...}.
function artefactText(artefact) {
  if (artefact === null || typeof artefact !== "object") return String(artefact);
  const { name, ...rest } = artefact;
  const more = Object.entries(rest).map(([key, value]) => quantity(value, [key]) + (key === "seconds" ? "" : ` ${key.split("_")[0]}`));
  return more.length > 0 ? `${name} (${more.join(", ")})` : String(name);
}

/// What of the scene was there and not needed.
function leftOut({ scene = {} }) {
  const { textures } = scene;
  const unread = (textures?.in_scene ?? 0) - (textures?.decoded ?? 0);
  return [
    ...Object.keys(scene).filter((key) => scene[key] === "not needed").map(words),
    ...(unread > 0 ? [`${number(unread)} of ${number(textures.in_scene)} textures`] : []),
  ];
}

function builtList(report) {
  const rows = { built: [], loaded: [], left_out: [], ...report.artefacts };
  rows.left_out = [...rows.left_out, ...leftOut(report)];
  return h("section.stacked", h("h3", "Built for it"),
    facts(Object.entries(rows).map(([key, list]) => [words(key), list.map(artefactText).join(", ") || "nothing"])));
}

/// CPU seconds are the same work on another clock, so they are no part of the whole.
export const effortView = (report) => h("div.effort",
  bar("Time", report.seconds, seconds, (name) => !name.endsWith("cpu")),
  bar("Rays", report.counts, number, (name) => ["rays", "shadow rays"].includes(name)),
  builtList(report));
