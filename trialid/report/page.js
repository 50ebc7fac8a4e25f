/* The report's own page: all its trials, drawn from the data inside it; nothing is fetched. */

import { build, resize, shareSignals, trialOf } from "./plots.js";
import { draw } from "./plots/chart.js";
import { around } from "./plots/zoom.js";

const trials = JSON.parse(document.getElementById("series").textContent).map((data, index) => trialOf(data, index));
const articleOf = (trial) => document.getElementById("trial-" + trial.index);
trials.forEach((trial) => build(trial, articleOf(trial), document.querySelector("h1").textContent));
shareSignals(trials, [...document.querySelectorAll(".trial .signals")]);
const plots = trials.flatMap((trial) => trial.plots);

const redraw = () => plots.filter((plot) => plot.chart).forEach(draw);

/* Drawn when first seen: five trials would otherwise cost a second before the page answers. */
function drawWhenSeen() {
  const plotOf = new Map(plots.map((plot) => [plot.box, plot]));
  const seen = new IntersectionObserver((entries) => {
    entries.filter((entry) => entry.isIntersecting).forEach((entry) => {
      seen.unobserve(entry.target);
      const plot = plotOf.get(entry.target);
      if (!plot.chart) draw(plot);
    });
  }, { rootMargin: "400px" });
  const first = plots.filter((plot) => plot.box.getBoundingClientRect().top < window.innerHeight);
  first.forEach(draw);
  plots.filter((plot) => !plot.chart).forEach((plot) => seen.observe(plot.box));
}

/* Paper: every plot, in the light colours, as wide as the sheet; closed tables opened, and closed again after. */
function listenToPrinting() {
  let closed = [];
  window.addEventListener("beforeprint", () => {
    document.documentElement.dataset.print = "";
    closed = [...document.querySelectorAll("details:not([open])")];
    closed.forEach((each) => { each.open = true; });
    plots.forEach(draw);
  });
  window.addEventListener("afterprint", () => {
    delete document.documentElement.dataset.print;
    closed.forEach((each) => { each.open = false; });
    redraw();
  });
}

/* "Show" beside a finding: its stretch with as much again around it. */
function listenToFinding(button) {
  const trial = trials.find((each) => each.name === button.dataset.trial);
  if (!trial) { button.hidden = true; return; }
  button.addEventListener("click", () => {
    around(trial, Number(button.dataset.from), Number(button.dataset.to));
    const article = articleOf(trial);
    article.scrollIntoView();
    article.querySelector(".panels").focus({ preventScroll: true });
  });
}

drawWhenSeen();
new ResizeObserver(() => resize(plots)).observe(document.querySelector("main"));
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
listenToPrinting();
document.querySelectorAll("button[data-trial]").forEach(listenToFinding);
