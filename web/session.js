// The token of a service that asks for one: it is typed once, and the service keeps it in a cookie.
import { ask } from "./dialog.js";
import { h } from "./dom.js";

let asking = null;

function askToken(post) {
  const field = h("input", { type: "password", required: true, autocomplete: "off" });
  return ask("This service requires a token", [
    h("p", "The token is in the file passed to lacuna-server as --token-file."),
    h("label", "Token ", field)], "Go on", () => post(field.value));
}

/// Asks for the token, once for all that wait for it, until `post(token)` succeeds or the reader
/// gives up; gives whether it did.
export function signIn(post) {
  asking ??= askToken(post).finally(() => { asking = null; });
  return asking;
}
