// Where a job's time and rays went, and what it built, from report.json.
import { h } from "./dom.js";
import { number, quantity, seconds, words } from "./format.js";
import { stackedBar } from "./stacked_bar.js";

/// "load", "build voxelise", ...: the numbers of an object, also of nested ones.
function numbersIn(object, path = "") {
  return Object.entries(object ?? {}).flatMap(([key, value]) => {
    const name = path ? `${path} ${words(key)}` : words(key);
    if (value !== null && typeof value === "object") return numbersIn(value, name);
    return typeof value === "number" ? [{ name, value }] : [];
  });
}

/// CPU seconds are the same work on another clock, so they are no part of the whole.
function timeBar(report) {
  const parts = numbersIn(report.seconds).filter(({ name }) => !name.endsWith("cpu"))
    .map((p) => ({ ...p, text: seconds(p.value) })).sort((a, b) => b.value - a.value);
  const total = parts.reduce((sum, p) => sum + p.value, 0);
  return parts.length > 0 && stackedBar(`Time: ${seconds(total)} in all`, parts);
}

function rayBar({ counts = {} }) {
  const parts = Object.entries(counts).filter(([key]) => ["rays", "shadow_rays"].includes(key))
    .map(([key, value]) => ({ name: words(key), value, text: number(value) }));
  return parts.length > 0 && stackedBar(
    `Rays: ${number(parts.reduce((sum, p) => sum + p.value, 0))} in all`, parts);
}

/// An artefact is a name, or {name, seconds, bytes, ...}.
function artefactText(artefact) {
  if (artefact === null || typeof artefact !== "object") return String(artefact);
  const { name, ...rest } = artefact;
  const more = Object.entries(rest).map(([key, value]) => quantity(value, [key]));
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
  return h("section", { className: "stacked" }, h("h3", {}, "Built for it"),
    h("dl", { className: "facts" }, Object.entries(rows).map(([key, list]) => h("div", {},
      h("dt", {}, words(key)),
      h("dd", {}, [list].flat().map(artefactText).join(", ") || "nothing")))));
}

export const effortView = (report) => h("div", { className: "effort" },
  timeBar(report), rayBar(report), builtList(report));
