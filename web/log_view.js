// A job's log: its last part, followed while the job runs.
import { fileUrl, getLog } from "./api.js";
import { h, setText } from "./dom.js";
import { bytes } from "./format.js";

const tail = 1 << 16;

/// `update(size)` says how large log.txt is; it is read only while the log is open. null: there is none.
export function logView(id, signal) {
  const text = h("pre.tall", { tabIndex: 0, "aria-label": "Log" });
  const note = h("p.note");
  const element = h("details", { hidden: true, ontoggle: follow }, h("summary", "Log"), text, note);
  let decoder;
  let begin = 0;
  let end = null;
  let size = 0;
  let reading = false;

  /// What comes after what is there; from the tail on if there is nothing, or a new, shorter log.
  async function readOn() {
    const anew = end === null || size < end;
    if (anew) [begin, end, decoder] = [Math.max(0, size - tail), Math.max(0, size - tail), new TextDecoder()];
    const { data, next } = await getLog(id, end, signal);
    end = next;
    size = Math.max(size, next);  // it may have grown since its size was told
    const more = decoder.decode(data, { stream: true });
    const atEnd = anew || text.scrollTop + text.clientHeight >= text.scrollHeight - 4;
    // A part that begins amid the file begins amid a line, perhaps amid a letter.
    if (anew) text.textContent = begin > 0 ? more.slice(more.indexOf("\n") + 1) : more;
    else text.append(more);
    if (atEnd) text.scrollTop = text.scrollHeight;
  }

  async function follow() {
    if (!element.open || reading) return;
    reading = true;
    try {
      while (size !== end && !signal.aborted) await readOn();
      note.replaceChildren(begin > 0 ? `The last part of it, from ${bytes(begin)} on. ` : "",
        h("a", { href: fileUrl(id, "log.txt") }, "The whole log"));
    } catch (error) {
      end = null;
      if (!signal.aborted) setText(note, error.message);
    }
    reading = false;
  }

  return {
    element,
    update(next) {
      element.hidden = next === null;
      size = next ?? 0;
      follow();
    },
  };
}
