/* What the server says of its work, and the parts of the page that come with it. */

import { complain } from "./complaints.js";
import { replace } from "./parts.js";
import { answer, byId, keyed, partOf, state } from "./state.js";
import { choose, follow, followAgain } from "./trials.js";
import { markTried } from "./use.js";

const AGAIN = 1000;                   // ms until the parts are asked for again

export function hear(status) {
  if (state.status && status.serial < state.status.serial) return;
  const before = state.status;
  state.status = status;
  state.version = status.version;
  working(status.working);
  reversible("undo", status.undo);
  reversible("redo", status.redo);
  byId("again").hidden = Boolean(status.working) || status.stage === "diagnosed";
  complain();
  markTried();
  announce(before, status);
  if (status.screen !== state.screen) refresh();
  else follow();
}

function working(now) {
  byId("working").hidden = !now;
  if (!now) return;
  byId("working-words").textContent = now.why ? now.why + ": " + now.words : now.words;
  const progress = byId("progress");
  if (now.share === null) progress.removeAttribute("value");
  else progress.value = now.share;
}

function reversible(name, words) {
  const button = byId(name);
  const verb = name === "undo" ? "Undo" : "Redo";
  button.disabled = !words;
  button.title = words ? verb + ": " + words : "Nothing to " + name;
  button.setAttribute("aria-label", words ? verb + ": " + words : verb);
}

/* For who does not see the screen: that a fit began, and what it came to. */
function announce(before, now) {
  const [was, is] = [before && before.working, now.working];
  if (is && (!was || was.why !== is.why)) byId("said").textContent = is.why || is.words;
  if (was && !is && !now.trouble) state.finished = true;
}

function sayResult() {
  if (!state.finished || state.status.working) return;
  state.finished = false;
  const number = byId("error-number");
  if (number) byId("said").textContent = "Done. Error of the model: " + number.textContent.trim();
}

let fetching = false;

async function refresh() {
  if (fetching) return;
  fetching = true;
  try {
    while (state.status.screen !== state.screen) {
      const told = await answer("/api/screen");
      state.screen = told.screen;
      show(told.parts);
      if (told.screen < state.status.screen) continue;
      break;
    }
  } catch {
    if (!state.lost) setTimeout(refresh, AGAIN);
    return;
  } finally { fetching = false; }
  sayResult();
  follow();
}

function show(parts) {
  const changed = Object.keys(parts).filter((name) => parts[name] !== state.html[name] && partOf(name));
  changed.forEach((name) => replace(partOf(name), parts[name]));
  Object.assign(state.html, parts);
  if (changed.includes("title")) document.title = partOf("title").querySelector("h1").textContent + " \u2013 trialid";
  choose(state.trial);
  followAgain();
  complain();
}

/* An edit in the name of a control; a refusal is told beside it. */
export async function edit(path, body, key) {
  state.edited = key;
  state.refused = null;
  forget(key);
  complain();
  try {
    const told = await answer(path, { version: state.version, ...body });
    hear(told);
    return true;
  } catch (error) {
    if (error.kind !== "lost") state.refused = { key, words: error.message };
    complain();
    if (error.kind === "changed") hear(await answer("/api/status"));
    return false;
  }
}

/* What was refused before is not asked for any more: those fields hold again what the pipeline says. */
function forget(key) {
  const row = keyed(key) && keyed(key).closest("[data-row]");
  document.querySelectorAll("input[aria-invalid]").forEach((input) => {
    if (row && row.contains(input)) return;
    input.value = input.defaultValue;
    input.removeAttribute("aria-invalid");
  });
}
