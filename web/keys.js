// The keys of the page, listed when ? is pressed.
import { ask } from "./dialog.js";
import { facts } from "./dom.js";

const keys = [
  ["?", "this list"], ["Esc", "closes a question"],
  ["e, E", "brighter, darker by half a stop"], ["[, ]", "the layer before, after"],
  ["+, −, wheel", "zoom; the wheel once the picture has the focus"], ["arrows, drag", "move the picture"],
  ["0 or f, o", "fit; one to one"], ["1 … 9", "of several pictures: that one"],
  [", .", "move the line between two pictures; make the crop smaller, larger"],
  ["arrows, drag", "of crops: move the crop; choose another"],
];

/// Shows them, unless a question is open already.
export const showKeys = () => document.querySelector("dialog")
  ?? ask("Keys", [facts(keys, "keys-help"), "Those of pictures count while one has the focus."]);

document.addEventListener("keydown", (event) => {
  if (event.key === "?" && !event.target.matches("input, textarea, select")) showKeys();
});
document.getElementById("keys").onclick = showKeys;
