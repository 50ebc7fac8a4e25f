/* Which panels of a trial are seen: a menu of its signals. */

import { draw } from "./chart.js";

/* Signals by the titles of their panels, each once, in the order of the panels. */
export const signalsOf = (trials) => [...new Set(trials.flatMap((trial) => trial.plots.map((plot) => plot.drawing.title)))];

/* Panels that are not chosen go, those that come again are drawn; the time axis moves to what is left. */
export function choosePanels(trial, hidden) {
  trial.hidden = hidden;
  const again = trial.plots.filter((plot) => plot.chart || plot.panel.hidden);
  trial.plots.forEach((plot) => { plot.panel.hidden = hidden.has(plot.drawing.title); });
  again.forEach(draw);
}

/* A tick for each signal; `choose` is told what is hidden, which the menu keeps in the same set. */
export function fillMenu(menu, titles, hidden, choose) {
  menu.hidden = titles.length < 2;
  menu.querySelector(".menu-box").replaceChildren(...titles.map((title) => tickOf(title, hidden, choose)));
}

function tickOf(title, hidden, choose) {
  const label = document.createElement("label");
  const input = document.createElement("input");
  input.type = "checkbox";
  input.checked = !hidden.has(title);
  input.dataset.signal = title;
  input.addEventListener("change", () => {
    if (input.checked) hidden.delete(title);
    else hidden.add(title);
    choose();
  });
  label.append(input, title);
  return label;
}

/* A menu closes when something else is pressed, or by Escape. */
export function closeMenus() {
  const close = (event) => document.querySelectorAll(".signals[open]").forEach((menu) => {
    if (event.key === "Escape" || (event.type === "click" && !menu.contains(event.target))) menu.open = false;
  });
  document.addEventListener("click", close);
  document.addEventListener("keydown", close);
}
