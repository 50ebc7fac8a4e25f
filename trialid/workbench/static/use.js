/* The model in use: a manoeuvre tried on the spot. What comes back goes in as text. */

import { answer, byId } from "./state.js";
import { pictures } from "./tried.js";

export async function tryManoeuvre(form) {
  const told = byId("tried");
  told.replaceChildren(paragraph("Sailing \u2026 (the first time takes some seconds)", "note"));
  try {
    show(told, await answer("/api/try", { orders: form.elements.orders.value.trim() }));
  } catch (error) {
    told.replaceChildren(paragraph(error.message, "complaint"));
  }
}

function show(place, made) {
  const table = document.createElement("table");
  table.append(row(["", "value", "likely"], "th"), ...made.rows.map((each) => row(each, "td")));
  const name = document.createElement("h3");
  name.textContent = made.name;
  place.replaceChildren(name, table, pictures(made.picture), ...made.words.map((words) => paragraph(words, "note")));
}

function row(cells, kind) {
  const line = document.createElement("tr");
  cells.forEach((text, place) => {
    const cell = document.createElement(place === 0 ? "th" : kind);
    cell.textContent = text;
    if (place > 0) cell.className = "n";
    line.append(cell);
  });
  return line;
}

function paragraph(words, kind) {
  const made = document.createElement("p");
  made.className = kind;
  made.textContent = words;
  return made;
}
