/* The model in use: a manoeuvre tried on the spot, a file of it saved. What comes back goes in as text. */

import { answer, ask, byId, state } from "./state.js";
import { pictures } from "./tried.js";

const EARLIER = "Sailed by an earlier model: sail again for the one shown now.";

let sailed = null;                    // what was on the screen when the manoeuvre was asked for

const model = () => state.version + " " + (state.status && state.status.series);

export async function tryManoeuvre(form) {
  const told = byId("tried");
  told.replaceChildren(paragraph("Sailing \u2026 (the first time takes some seconds)", "note"));
  sailed = model();
  try {
    show(told, await answer("/api/try", { orders: form.elements.orders.value.trim() }));
    markTried();
  } catch (error) {
    told.replaceChildren(paragraph(error.message, "complaint"));
  }
}

/* What was sailed stays to be compared with, and says that it is no more of the model shown. */
export function markTried() {
  const told = byId("tried");
  if (sailed === model() || !told.querySelector("table") || told.querySelector(".warn")) return;
  told.prepend(paragraph(EARLIER, "warn"));
  told.classList.add("earlier");
}

/* A file of the model, saved; a refusal is told in its row. */
export async function handOver(row, path) {
  row.querySelectorAll(".complaint").forEach((each) => each.remove());
  try {
    const reply = await ask(path);
    const [, name] = reply.headers.get("content-disposition").match(/filename="([^"]+)"/);
    save(await reply.blob(), name);
  } catch (error) {
    const told = paragraph(error.message, "complaint");
    told.setAttribute("role", "alert");
    row.append(told);
    told.scrollIntoView({ block: "nearest" });
  }
}

function save(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function show(place, made) {
  const table = document.createElement("table");
  table.append(row(["", "value", "likely"], "th"), ...made.rows.map((each) => row(each, "td")));
  const name = document.createElement("h3");
  name.textContent = made.name;
  place.classList.remove("earlier");
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
