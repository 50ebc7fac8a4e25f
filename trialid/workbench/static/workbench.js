/* The workbench: shows what the server knows and sends every edit to it. Words and names from data go in as
   text; only the parts that the server renders, where every name is escaped, go in as HTML. */

import { complain } from "./complaints.js";
import { addNamed, boundsLeft, entered, isEdit, send, tick, value } from "./edits.js";
import { activate, goBack, shortcut, tabKey } from "./keys.js";
import { answer, byId, state } from "./state.js";
import { edit, hear } from "./status.js";
import { tryManoeuvre } from "./use.js";
import { listenToPlots, setBeside, showStretch } from "./trials.js";

function pressed(event) {
  const button = event.target.closest("button");
  if (!button) return;
  if (button.getAttribute("role") === "tab") activate(button);
  else if (button.dataset.show !== undefined) showStretch(button);
  else if (isEdit(button)) send(button);
}

function changed(event) {
  const input = event.target;
  if (input.id === "beside") setBeside(input.checked);
  else if (input.dataset.do === "free") tick(input);
  else if (input.dataset.do === "value") value(input);
}

async function submitted(event) {
  const form = event.target;
  if (form.hasAttribute("action")) return;             // a download, which leaves the page as it is
  event.preventDefault();
  if (form.id === "export-copy") await exported({ name: form.elements.name.value.trim() });
  else if (form.id === "try") await tryManoeuvre(form);
  else if (form.dataset.do === "add") await addNamed(form.elements.effect);
}

async function exported(body) {
  const told = byId("exported");
  told.className = "told";
  told.textContent = "Writing \u2026";
  try {
    told.textContent = "Written:\n" + (await answer("/api/export", body)).files.join("\n");
  } catch (error) {
    told.className = "told bad";
    told.textContent = error.message;
  }
}

function listenToPage() {
  document.addEventListener("click", pressed);
  document.addEventListener("change", changed);
  document.addEventListener("focusout", boundsLeft);
  document.addEventListener("submit", submitted);
  document.addEventListener("keydown", tabKey);
  document.addEventListener("keydown", entered);
  document.addEventListener("keydown", shortcut);
  document.addEventListener("click", (event) => { if (!event.target.closest("#export")) byId("export").open = false; });
}

function listenToBar() {
  byId("undo").addEventListener("click", () => goBack("undo"));
  byId("redo").addEventListener("click", () => goBack("redo"));
  byId("cancel").addEventListener("click", () => answer("/api/cancel", {}).catch(() => {}));
  byId("again").addEventListener("click", () => edit("/api/again", {}, null));
  byId("export-run").addEventListener("click", () => exported({}));
}

function connect() {
  const events = new EventSource("/api/events");
  const found = (lost) => { if (state.lost !== lost) { state.lost = lost; complain(); } };
  // A workbench that was started anew counts from the beginning.
  events.onopen = () => { if (state.lost) Object.assign(state, { status: null, screen: null, drawn: null }); found(false); };
  events.onmessage = (event) => { found(false); hear(JSON.parse(event.data)); };
  events.onerror = () => found(true);
}

listenToPage();
listenToBar();
listenToPlots();
connect();
