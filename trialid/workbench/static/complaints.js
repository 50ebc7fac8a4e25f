/* What went wrong: about an edit, beside its control where that is still there and seen; all else under the bar. */

import { byId, keyed, LOST, state } from "./state.js";

export function complain() {
  const trouble = state.status && state.status.trouble;
  const told = complaint(trouble);
  const row = told && told.key && rowOf(told.key);
  banner(bannerWords(trouble, told, row));
  const shown = [...document.querySelectorAll(".complaint[data-edit]")];
  if (row && shown.length === 1 && shown[0].parentElement === row && shown[0].textContent === told.words) return;
  shown.forEach((each) => each.remove());
  if (row) complainIn(row, told.words, shown.length === 0);
  if (row) told.seen = true;
}

/* Without a connection nothing else is news; a refusal that was seen beside its control waits for who comes back. */
function bannerWords(trouble, told, row) {
  if (state.lost) return LOST[state.lost];
  if (trouble && !taken(trouble)) return trouble.words;
  return told && !row && !told.seen ? told.words : "";
}

/* About an edit: refused, or taken back since it could not be fitted. */
function complaint(trouble) {
  if (state.refused) return state.refused;
  return trouble && taken(trouble) ? { key: state.edited, words: trouble.words } : null;
}

/* Whether it is about an edit, which was taken back, and not about a file as somebody left it. */
const taken = (trouble) => trouble.where === "fit" || trouble.words.endsWith("taken back");

function rowOf(key) {
  const control = keyed(key);
  const row = control && control.closest("[data-row]");
  return row && row.checkVisibility() ? row : null;
}

function complainIn(row, words, fresh) {
  const told = complaintOf(words);
  row.append(told);
  if (fresh) told.scrollIntoView({ block: "nearest" });
}

function complaintOf(words) {
  const told = document.createElement("p");
  told.className = "complaint";
  told.dataset.edit = "";
  told.setAttribute("role", "alert");
  told.textContent = words;
  return told;
}

function banner(words) {
  const place = byId("banner");
  if (place.textContent !== words) place.textContent = words;
  place.hidden = !words;
}

/* What an input holds is refused here already, without asking the server. */
export function refuse(input, words) {
  input.setAttribute("aria-invalid", "true");
  state.refused = { key: input.dataset.key, words };
  complain();
}
