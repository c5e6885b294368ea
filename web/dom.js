// Builds and changes elements, and shows dialogs. Text only becomes text nodes, so that no name can become markup.

/// An element: "tag.class.class", its properties if there are any, and children. Properties whose name has a dash, and
/// `role`, are set as attributes. Children are nodes, text or numbers, also in arrays; undefined, null, false and ""
/// are skipped.
export function h(tag, ...content) {
  const [name, ...classes] = tag.split(".");
  const element = document.createElement(name);
  if (classes.length > 0) element.className = classes.join(" ");
  const properties = content[0]?.constructor === Object ? content.shift() : {};
  append(element, content);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (key === "role" || key.includes("-")) element.setAttribute(key, value);
    else element[key] = value;
  }
  return element;
}

export function append(element, ...children) {
  for (const child of children.flat(Infinity)) {
    if (child === undefined || child === null || child === false || child === "") continue;
    element.append(child instanceof Node ? child : String(child));
  }
}

/// Replaces the children of `element`, given as for h().
export function replace(element, ...children) {
  element.replaceChildren();
  append(element, ...children);
}

/// As replace(), with newly made children: elements equal to existing ones stay, with focus, selection and loaded
/// pictures. Children with an `id` are matched by it, others by their position.
export function update(element, ...children) {
  const next = document.createElement(element.nodeName);
  append(next, ...children);
  patchChildren(element, next);
}

function patchChildren(old, next) {
  const wanted = [...next.childNodes];
  const byId = new Map([...old.children].filter((child) => child.id).map((child) => [child.id, child]));
  wanted.forEach((child, i) => {
    const there = old.childNodes[i] ?? null;
    const kept = child.id ? byId.get(child.id) : there;
    if (kept?.nodeName !== child.nodeName || (kept.id ?? "") !== (child.id ?? "")) {
      if (there && !there.id) there.replaceWith(child);
      else old.insertBefore(child, there);
    } else {
      if (kept !== there) old.insertBefore(kept, there);
      patch(kept, child);
    }
  });
  while (old.childNodes.length > wanted.length) old.lastChild.remove();
}

// State of elements that is neither attribute nor child.
const properties = ["onclick", "onchange", "oninput", "checked", "value"];

/// Changes `old` to equal `next`, a node of the same name.
export function patch(old, next) {
  if (old instanceof Text) {
    if (old.data !== next.data) old.data = next.data;
    return;
  }
  for (const { name } of [...old.attributes]) if (!next.hasAttribute(name)) old.removeAttribute(name);
  for (const { name, value } of next.attributes) if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  patchChildren(old, next);
  // Keeps text that the user is typing.
  const typed = old === document.activeElement && old.matches("input:not([type=checkbox])");
  for (const key of properties) if (next[key] !== old[key] && !(key === "value" && typed)) old[key] = next[key];
}

/// Names and values; empty values are skipped.
export const facts = (pairs, className = "facts") => h("dl", { className }, pairs
  .filter(([, value]) => value !== "" && value !== null && value !== undefined)
  .map(([name, value]) => h("div", h("dt", name), h("dd", value))));

/// The URL of this view with `query` (URLSearchParams), and setting it without a new history entry.
export const addressOf = (query) =>
  `${(location.hash || "#/").split("?")[0]}?${query}`.replaceAll("%2C", ",").replace(/\?$/, "");
export const remember = (query) => history.replaceState(null, "", addressOf(query));

/// Sets `values` in `query` and the URL; deletes empty ones.
export function keep(query, values) {
  for (const [key, value] of Object.entries(values)) {
    if (value) query.set(key, value);
    else query.delete(key);
  }
  remember(query);
}

/// `chooser(query, draw)(key)` handles a choice: it stores the value in `query` and the URL, and draws.
export const chooser = (query, draw) => (key) => (value) => {
  query.set(key, value);
  remember(query);
  draw();
};

/// A button; `props` as for h().
export const button = (text, onclick, props = {}) => h("button", { type: "button", onclick, ...props }, text);
/// A small button; the label explains a symbol.
export const small = (text, onclick, label = null) =>
  button(text, onclick, { className: "small", title: label, "aria-label": label });

/// The handler of a button: `call()`, then `then()` unless it returned false; errors go to `say(text)`.
export const action = (call, then, say) => async () => {
  say("");
  try {
    if (await call() !== false) await then();
  } catch (error) {
    say(error.message);
  }
};

/// An empty list: its description, and the command that creates the first item.
export const emptyPlace = (title, text, command) => h("section.empty", h("h2", title), h("p", text),
  h("pre", { tabIndex: 0 }, command), copyButton(command));

/// A button that copies `text` and confirms it.
export const copyButton = (text) => small("Copy", async ({ target }) => {
  const copied = await navigator.clipboard?.writeText(text).then(() => true, () => false);
  target.textContent = copied ? "Copied" : "Not allowed here: select and copy";
  setTimeout(() => { target.textContent = "Copy"; }, 2000);
});

/// Saves a blob as a file.
export function save(blob, name) {
  const href = URL.createObjectURL(blob);
  h("a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), 10_000);
}

export const problem = (text) => h("p.problem", { role: "alert" }, text);
export const warning = (text) => h("p.warning", text);
export const note = (...content) => h("p.note", content);

/// A select of `options` [{key, label, group}]; `onchange(key)`.
export function select(options, value, onchange, props = {}) {
  const items = (group) => options.filter((o) => o.group === group).map((o) => h("option", { value: o.key }, o.label));
  const groups = [...new Set(options.map((o) => o.group))];
  return h("select", { ...props, value, onchange: (event) => onchange(event.target.value) },
    groups.map((group) => (group ? h("optgroup", { label: group }, items(group)) : items(group))));
}

/// A select after its label, which is unique on the page.
export const choice = (label, ...given) => h("span.choice", h("label", { htmlFor: `choose-${label}` }, label), " ",
  select(...given, { id: `choose-${label}` }));

/// A scrollable container for a table wider than the page.
export const scroll = (label, content) => h("div.scroll", { tabIndex: 0, role: "group", "aria-label": label }, content);

/// A table: rows of children of h(); the first cell is the row's header, and with `numbers` the others are numbers.
export function table(columns, rows, numbers = false) {
  const cell = (tag, scope) => (content, i) => h(i === 0 && scope === "row" ? "th" : tag, {
    scope: i === 0 || tag === "th" ? scope : null, className: numbers && i > 0 ? "number" : "" }, content);
  return scroll("Table", h("table.values",
    h("thead", h("tr", columns.map(cell("th", "col")))),
    h("tbody", rows.map((row) => h("tr", row.map(cell("td", "row")))))));
}

/// Shows a modal dialog with `content` (as for h()); returns whether the answer was `yes`, which runs `act()`: its
/// errors are shown, and the dialog stays. Without `yes` the dialog only shows text.
export function ask(title, content, yes = null, act = () => {}) {
  return new Promise((resolve) => {
    const trouble = h("div");
    const agree = yes && h("button", { type: "submit" }, yes);
    async function onsubmit(event) {
      event.preventDefault();
      agree.disabled = true;
      await action(act, () => dialog.close("yes"), (text) => replace(trouble, text && problem(text)))();
      agree.disabled = false;
    }
    const dialog = h("dialog", {
      "aria-label": title,
      onclose: () => {
        dialog.remove();
        resolve(dialog.returnValue === "yes");
      },
    }, h("form", { onsubmit }, h("h2", title), content, trouble,
      h("div.tools", agree, button(yes ? "Back" : "Close", () => dialog.close()))));
    document.body.append(dialog);
    dialog.showModal();
  });
}
