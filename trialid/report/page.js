/* The report's own page: all its trials, drawn from the data inside it; nothing is fetched. */
(function () {
  "use strict";

  const { trialOf, build, draw, around, resize } = trialidPlots;

  const trials = JSON.parse(document.getElementById("series").textContent).map((data, index) => trialOf(data, index));
  const articleOf = (trial) => document.getElementById("trial-" + trial.index);
  trials.forEach((trial) => build(trial, articleOf(trial)));
  const plots = trials.flatMap((trial) => trial.plots);
  const plotOf = new Map(plots.map((plot) => [plot.box, plot]));

  /* Drawn when first seen: five trials would otherwise cost a second before the page answers. */
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

  const redraw = () => plots.filter((plot) => plot.chart).forEach(draw);
  new ResizeObserver(() => resize(plots)).observe(document.querySelector("main"));
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  /* Paper: every plot, in the light colours, as wide as the sheet; closed tables opened, and closed again after. */
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

  /* "Show" beside a finding: its stretch with as much again around it. */
  document.querySelectorAll("button[data-trial]").forEach((button) => {
    const trial = trials.find((each) => each.name === button.dataset.trial);
    if (!trial) { button.hidden = true; return; }
    button.addEventListener("click", () => {
      around(trial, Number(button.dataset.from), Number(button.dataset.to));
      const article = articleOf(trial);
      article.scrollIntoView();
      article.querySelector(".panels").focus({ preventScroll: true });
    });
  });
})();
