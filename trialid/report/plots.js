/* The plots of trials: panels under one another that zoom together. For the report and the workbench;
   data are given, nothing is fetched. */

import { place } from "./plots/chart.js";
import { drawings } from "./plots/drawings.js";
import { clock } from "./plots/numbers.js";
import { savePicture } from "./plots/picture.js";
import { choosePanels, closeMenus, fillMenu, signalsOf } from "./plots/signals.js";
import { HEIGHTS, onPaper } from "./plots/sizes.js";
import { listen } from "./plots/zoom.js";

/* What is drawn of a trial; `beside`: with the prediction of the model before, where there is one. */
export function trialOf(data, index, heights = HEIGHTS, beside = true, hidden = new Set()) {
  let t;
  const trial = { name: data.name, index, heights, beside, hidden, t: () => (t = t || clock(data.t)), plots: [] };
  const times = trial.t();
  trial.from = times.length ? times[0] : 0;
  trial.to = times.length ? times[times.length - 1] : 1;
  trial.period = (trial.to - trial.from) / Math.max(times.length - 1, 1);
  trial.window = { min: trial.from, max: trial.to };
  const all = data.panels.flatMap(drawings);
  trial.plots = all.map((drawing) => ({ trial, drawing, gaps: [] }));
  return trial;
}

/* The panels into their article, empty; what stood there goes. */
export function fill(trial, article) {
  article.querySelector(".panels").replaceChildren(...trial.plots.map(place));
  trial.told = article.querySelector(".window");
  trial.track = trial.track || (() => article.querySelector("svg.track"));
}

export function build(trial, article, title) {
  fill(trial, article);
  listen(article, () => trial);
  article.querySelector("[data-save]").addEventListener("click", () => savePicture(trial, title));
}

/* The menus of articles that show their trials side by side: one choice of signals for all of them. */
export function shareSignals(trials, menus) {
  const titles = signalsOf(trials);
  const hidden = new Set();
  const choose = () => {
    trials.forEach((trial) => choosePanels(trial, hidden));
    menus.forEach(refill);
  };
  const refill = (menu) => fillMenu(menu, titles, hidden, choose);
  menus.forEach(refill);
  closeMenus();
}

/* As wide as their boxes are now. */
export function resize(plots) {
  plots.forEach((plot) => {
    const width = plot.box.clientWidth;
    if (plot.chart && width && !onPaper() && plot.chart.width !== width) {
      plot.chart.setSize({ width, height: plot.chart.height });
    }
  });
}

/* The prediction of the model before, shown or not. */
export function setBeside(trial, beside) {
  trial.beside = beside;
  trial.plots.forEach((plot) => plot.drawing.lines.forEach((line, k) => {
    if (line.before && plot.chart) plot.chart.setSeries(k + 1, { show: beside });
  }));
}
