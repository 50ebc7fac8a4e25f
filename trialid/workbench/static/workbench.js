/* The workbench: shows what the server knows and sends every edit to it. Words and names from data go in as
   text; only the parts that the server renders, where every name is escaped, go in as HTML. */

import { complain } from "./complaints.js";
import { addNamed, boundsLeft, entered, isEdit, send, tick, value } from "./edits.js";
import { activate, goBack, shortcut, tabKey } from "./keys.js";
import { answer, byId, state } from "./state.js";
import { edit, hear } from "./status.js";
import { handOver, tryManoeuvre } from "./use.js";
import { listenToPlots, setBeside, showStretch } from "./trials.js";

const AGAIN = 3000;                   // ms until a connection that was refused is sought again

function pressed(event) {
  const file = event.target.closest(".hand-over a");
  if (file) { event.preventDefault(); handOver(file.closest("[data-row]"), file.href); }
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
  event.preventDefault();
  if (form.id === "export-copy") await exported({ name: form.elements.name.value.trim() });
  else if (form.id === "try") await tryManoeuvre(form);
  else if (form.dataset.do === "hand-over") await handOver(form, form.dataset.path + "?" + new URLSearchParams(new FormData(form)));
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

/* The server's news. One that was started anew counts from the beginning; where the browser has given up, it is
   asked again, as its new address may have been opened by then. */
function connect() {
  const events = new EventSource("/api/events");
  events.onopen = () => { if (state.lost) Object.assign(state, { status: null, screen: null, drawn: null }); found(); };
  events.onmessage = (event) => { found(); hear(JSON.parse(event.data)); };
  events.onerror = async () => {
    await answer("/api/status").catch(complain);
    if (events.readyState === EventSource.CLOSED) setTimeout(connect, AGAIN);
  };
}

function found() {
  if (!state.lost) return;
  state.lost = null;
  complain();
}

listenToPage();
listenToBar();
listenToPlots();
connect();
