/* One panel as uPlot draws it. */

import { gaps, rounded } from "./numbers.js";
import { colour, noiseLines, predictionBand, shade, zeroLine } from "./painting.js";
import { AXIS, CLOCK, BESIDE, LOW, PAPER, onPaper, widthOf } from "./sizes.js";
import { choose, showAll } from "./zoom.js";

export function draw(plot) {
  if (plot.panel.hidden) return;
  if (plot.chart) plot.chart.destroy();
  plot.top.querySelectorAll(".u-legend").forEach((legend) => legend.remove());
  const values = plot.drawing.values();
  const t = plot.trial.t();
  const own = values[plot.drawing.kind === "output" ? 0 : values.length - 1];
  plot.empty = own.every((value) => value === null);      // a residual before there is a prediction
  plot.gaps = plot.drawing.kind === "input" || plot.empty ? [] : gaps(t, own);
  plot.chart = new uPlot(options(plot, widthOf(plot.box)), [t, ...values], plot.box);
  plot.chart.setScale("x", plot.trial.window);
}

function options(plot, width) {
  const { drawing, trial } = plot;
  const height = (onPaper() ? PAPER : trial.heights)[drawing.kind];
  const withClock = carriesClock(plot);
  return {
    width, height: height + (withClock ? CLOCK - 4 : 0), padding: [6, BESIDE, 0, 0],
    series: [clockSeries(), ...drawing.lines.map((line) => lineSeries(line, trial))],
    scales: { x: { time: false }, ...(plot.empty ? { y: { range: [-1, 1] } } : {}) },
    axes: [timeAxis(withClock), valueAxis(height, plot.empty)],
    legend: legendOf(plot),
    cursor: cursorOf(trial),
    hooks: {
      drawClear: [(u) => shade(u, plot)],
      drawAxes: [(u) => zeroLine(u, plot), (u) => predictionBand(u, plot)],
      draw: [(u) => noiseLines(u, plot)],
      setSelect: [(u) => choose(u, trial)],
    },
  };
}

/* The time stands under a residual and under the last of what is seen, and where a residual is hidden under its output. */
function carriesClock(plot) {
  const seen = plot.trial.plots.filter((each) => !each.panel.hidden);
  const next = seen[seen.indexOf(plot) + 1];
  const alone = plot.drawing.kind === "output" && (!next || next.drawing.kind !== "residual");
  return plot.drawing.kind === "residual" || !next || alone;
}

const clockSeries = () => ({
  label: "\u00a0", value: (u, v) => (v === null || v === undefined ? "" : v.toFixed(1) + " s"),
});

const lineSeries = (line, trial) => ({
  label: line.label, stroke: colour(line.other || line.stroke), width: line.width, dash: line.dash,
  points: { show: false }, show: !line.before || trial.beside, spanGaps: false,
  value: (u, v, each, k) => (k === null ? "" : rounded(v)),
});

function axis() {
  const line = { stroke: colour("grid"), width: 1 };
  const font = "11px system-ui, sans-serif";
  return { stroke: colour("soft"), grid: line, ticks: { ...line, size: 4 }, font };
}

function timeAxis(withClock) {
  return withClock
    ? { ...axis(), size: CLOCK, values: (u, at) => at.map((v) => v + " s") }
    : { ...axis(), size: 4, values: (u, at) => at.map(() => "") };
}

function valueAxis(height, empty) {
  const written = (v) => (empty ? "" : String(+v.toPrecision(6)).replace("-", "\u2212"));
  return { ...axis(), size: AXIS, space: height < LOW ? 15 : 24, values: (u, at) => at.map(written) };
}

function legendOf(plot) {
  const mount = (u, legend) => {
    legend.setAttribute("role", "presentation");
    plot.top.append(legend);
  };
  return { mount, markers: { width: 2 } };
}

/* Only the position travels between the panels: each would otherwise zoom on its own idea of the window. */
function cursorOf(trial) {
  const pub = (type) => type === "mousemove" || type === "mouseleave";
  return {
    y: false,
    drag: { x: true, y: false, setScale: false },
    sync: { key: "trial " + trial.index, filters: { pub } },
    bind: { dblclick: () => () => showAll(trial) },
  };
}

/* The box a panel is drawn in, with its heading. */
export function place(plot) {
  const panel = document.createElement("div");
  panel.className = "panel";
  panel.hidden = plot.trial.hidden.has(plot.drawing.title);
  plot.panel = panel;
  plot.top = document.createElement("div");
  plot.top.className = "top";
  plot.top.append(heading(plot.drawing));
  plot.box = boxOf(plot);
  panel.append(plot.top, plot.box);
  return panel;
}

function heading(drawing) {
  const title = document.createElement("span");
  const name = document.createElement("b");
  name.textContent = drawing.title;
  title.append(name, drawing.unit === "1" ? "" : " [" + drawing.unit + "]");
  return title;
}

function boxOf({ drawing, trial }) {
  const box = document.createElement("div");
  const lines = drawing.lines.map((line) => line.label).join(" and ");
  box.style.minHeight = Math.min(PAPER[drawing.kind], trial.heights[drawing.kind]) + "px";
  box.setAttribute("role", "img");
  box.setAttribute("aria-label", drawing.title + " of " + trial.name + ", " + lines + ", against time");
  return box;
}
