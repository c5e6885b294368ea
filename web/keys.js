// The keys of the page, listed when ? is pressed.
import { ask } from "./dialog.js";
import { facts } from "./dom.js";

const keys = [
  ["?", "show this list"], ["Esc", "close a dialog"],
  ["e, E", "exposure half a stop up, down"], ["[, ]", "previous, next layer"],
  ["+, −, wheel", "zoom (wheel: once the picture has the focus)"], ["arrows, drag", "move the picture"],
  ["0 or f, o", "fit to the window; one to one"], ["1 … 9", "show the picture with this number"],
  [", .", "move the divider of two pictures; make the crop smaller, larger"],
  ["arrows, drag", "crops: move the crop; choose another"],
];

/// Shows them, unless a question is open already.
export const showKeys = () => document.querySelector("dialog")
  ?? ask("Keys", [facts(keys, "keys-help"), "The keys for pictures work while a picture has the focus."]);

document.addEventListener("keydown", (event) => {
  if (event.key === "?" && !event.target.matches("input, textarea, select")) showKeys();
});
document.getElementById("keys").onclick = showKeys;
