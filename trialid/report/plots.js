/* The plots of trials: panels under one another that zoom together. For the report and the workbench;
   data are given, nothing is fetched. */
const trialidPlots = (() => {
  "use strict";

  const HEIGHTS = { input: 92, output: 178, residual: 112 };
  const PAPER = { input: 76, output: 150, residual: 96 };    // a trial with two outputs fills a page
  const AXIS = 52;          // px; the same in every panel, so that they stand under one another
  const CLOCK = 30;         // px below the panels that carry the time axis
  const LOW = 72;           // px; a panel below this height would else have a single number on its axis
  const PRINTED = 690;      // px; the width of an A4 page between its margins

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

  const onPaper = () => document.documentElement.dataset.print !== undefined;

  /* base64 of little-endian float32 to numbers; a gap, NaN, becomes the null that uPlot leaves open */
  function numbers(text) {
    const packed = atob(text);
    const bytes = new Uint8Array(packed.length);
    for (let k = 0; k < packed.length; k++) bytes[k] = packed.charCodeAt(k);
    const floats = new Float32Array(bytes.buffer);
    const values = new Array(floats.length);
    for (let k = 0; k < floats.length; k++) values[k] = Number.isNaN(floats[k]) ? null : floats[k];
    return values;
  }

  function clock(t) {
    if (t.each !== undefined) return numbers(t.each);
    return Array.from({ length: t.samples }, (_, k) => t.start + k * t.period);
  }

  /* The panels of a trial as drawn: an output is two of them, the residual below. */
  function drawings(panel) {
    if (panel.kind === "input") return [inputDrawing(panel)];
    const label = panel.symbol;
    let values;
    const read = () => (values = values || outputValues(panel));
    const before = panel.before === undefined ? [] : [{ label: "model before", stroke: "second", width: 1.2, before: true }];
    return [
      {
        kind: "output", title: panel.title, unit: panel.unit, stretches: panel.stretches,
        lines: [
          { label: "measured", stroke: "measured", width: 1 },
          ...before.map((line) => ({ ...line, dash: [5, 4] })),
          { label: "predicted", stroke: "predicted", width: 1.8 },
        ],
        values: () => [read().measured, ...read().before, read().predicted],
      },
      {
        kind: "residual", title: "residual of " + label, unit: panel.unit, stretches: panel.stretches, zero: true,
        noise: panel.noise,
        lines: [...before, { label: "measured \u2212 predicted", stroke: "residual", width: 1 }],
        values: () => [...read().before.map((predicted) => difference(read().measured, predicted)), read().residual],
      },
    ];
  }

  function inputDrawing(panel) {
    const strokes = ["predicted", "second", "residual", "measured"];
    return {
      kind: "input", title: panel.title, unit: panel.unit, stretches: [],
      lines: panel.lines.map((line, k) => ({ label: line.label, stroke: "measured", width: 1.2, other: k > 0 ? strokes[k % 4] : null })),
      values: () => panel.lines.map((line) => numbers(line.data)),
    };
  }

  function outputValues(panel) {
    const measured = numbers(panel.measured);
    const predicted = numbers(panel.predicted);
    const before = panel.before === undefined ? [] : [numbers(panel.before)];
    return { measured, predicted, before, residual: difference(measured, predicted) };
  }

  function difference(measured, predicted) {
    return measured.map((y, k) => (y === null || predicted[k] === null ? null : y - predicted[k]));
  }

  /* Runs of samples that were not measured, as [from, to] in seconds. */
  function gaps(t, values) {
    const found = [];
    for (let k = 0; k < t.length; k++) {
      if (values[k] !== null) continue;
      const from = k;
      while (k + 1 < t.length && values[k + 1] === null) k++;
      found.push([t[Math.max(from - 1, 0)], t[Math.min(k + 1, t.length - 1)]]);
    }
    return found;
  }

  function band(u, [from, to], fill) {
    const left = Math.max(u.valToPos(from, "x", true), u.bbox.left);
    const right = Math.min(u.valToPos(to, "x", true), u.bbox.left + u.bbox.width);
    if (right <= left) return;
    u.ctx.fillStyle = fill;
    u.ctx.fillRect(left, u.bbox.top, right - left, u.bbox.height);
  }

  function level(u, value, dashes) {
    const y = Math.round(u.valToPos(value, "y", true)) + 0.5;
    if (y < u.bbox.top || y > u.bbox.top + u.bbox.height) return;
    u.ctx.save();
    u.ctx.strokeStyle = colour(dashes.length ? "model" : "soft");
    u.ctx.lineWidth = 1;
    u.ctx.setLineDash(dashes);
    u.ctx.beginPath();
    u.ctx.moveTo(u.bbox.left, y);
    u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
    u.ctx.stroke();
    u.ctx.restore();
  }

  /* Zero under the residual; over it, how far noise alone goes. */
  function noiseLines(u, drawing) {
    if (drawing.noise) [drawing.noise, -drawing.noise].forEach((value) => level(u, value, [6, 4]));
  }

  function rounded(value) {
    if (value === null || value === undefined) return "\u2013";
    const places = Math.min(Math.max(2 - Math.floor(Math.log10(Math.abs(value) || 1)), 1), 5);
    return value.toFixed(places).replace("-", "\u2212");
  }

  function axes(withClock, height, empty) {
    const line = { stroke: colour("grid"), width: 1 };
    const font = "11px system-ui, sans-serif";
    const shared = { stroke: colour("soft"), grid: line, ticks: { ...line, size: 4 }, font };
    return [
      withClock
        ? { ...shared, size: CLOCK, values: (u, at) => at.map((v) => v + " s") }
        : { ...shared, size: 4, values: (u, at) => at.map(() => "") },
      { ...shared, size: AXIS, space: height < LOW ? 15 : 24, values: (u, at) => at.map((v) => (empty ? "" : String(+v.toPrecision(6)).replace("-", "\u2212"))) },
    ];
  }

  function options(plot, width) {
    const { drawing, trial } = plot;
    const heights = onPaper() ? PAPER : trial.heights;
    const withClock = drawing.kind === "residual" || plot.last;
    const lines = drawing.lines.map((line) => ({
      label: line.label, stroke: colour(line.other || line.stroke), width: line.width, dash: line.dash, points: { show: false },
      show: !line.before || trial.beside, value: (u, v, line, k) => (k === null ? "" : rounded(v)), spanGaps: false,
    }));
    return {
      width, height: heights[drawing.kind] + (withClock ? CLOCK - 4 : 0), padding: [6, 8, 0, 0],
      series: [{ label: "\u00a0", value: (u, v) => (v === null || v === undefined ? "" : v.toFixed(1) + " s") }, ...lines],
      scales: { x: { time: false }, ...(plot.empty ? { y: { range: [-1, 1] } } : {}) },
      axes: axes(withClock, heights[drawing.kind], plot.empty),
      legend: { mount: (u, legend) => { legend.setAttribute("role", "presentation"); plot.top.append(legend); }, markers: { width: 2 } },
      cursor: {
        y: false,
        drag: { x: true, y: false, setScale: false },
        // Only the position travels: each plot would otherwise zoom on its own idea of the window.
        sync: { key: "trial " + trial.index, filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } },
        bind: { dblclick: () => () => show(trial, trial.from, trial.to) },
      },
      hooks: {
        drawClear: [(u) => shade(u, plot)],
        drawAxes: [(u) => drawing.zero && !plot.empty && level(u, 0, [])],
        draw: [(u) => noiseLines(u, drawing)],
        setSelect: [(u) => choose(u, trial)],
      },
    };
  }

  function shade(u, plot) {
    plot.gaps.forEach((gap) => band(u, gap, colour("gap")));
    plot.drawing.stretches.forEach((stretch) => band(u, stretch, colour("stretch")));
  }

  /* A stretch dragged over becomes the window of the whole trial. */
  function choose(u, trial) {
    const { left, width } = u.select;
    if (width < 4) return;
    const [from, to] = [u.posToVal(left, "x"), u.posToVal(left + width, "x")];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    show(trial, from, to);
  }

  function show(trial, from, to) {
    const least = 5 * trial.period;
    const width = Math.min(Math.max(to - from, least), trial.to - trial.from);
    const start = Math.min(Math.max(from, trial.from), trial.to - width);
    trial.window = { min: start, max: start + width };
    trial.plots.forEach((plot) => plot.chart && plot.chart.setScale("x", trial.window));
    tell(trial);
  }

  /* The window in words, for eyes and for screen readers. */
  function tell(trial) {
    const { min, max } = trial.window;
    const all = max - min > trial.to - trial.from - 0.5 * trial.period;
    trial.told.textContent = all ? "" : min.toFixed(1) + " s to " + max.toFixed(1) + " s";
  }

  const KEYS = { ArrowLeft: "earlier", ArrowRight: "later", "+": "closer", "=": "closer", "-": "wider", "0": "all" };

  function pressed(event, trial) {
    const name = KEYS[event.key];
    if (!name || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    move(trial, name);
  }

  const MOVES = {
    earlier: (from, to) => [from - 0.5 * (to - from), to - 0.5 * (to - from)],
    later: (from, to) => [from + 0.5 * (to - from), to + 0.5 * (to - from)],
    closer: (from, to) => [from + 0.25 * (to - from), to - 0.25 * (to - from)],
    wider: (from, to) => [from - 0.5 * (to - from), to + 0.5 * (to - from)],
    all: () => [-Infinity, Infinity],
  };

  function move(trial, name) {
    const [from, to] = MOVES[name](trial.window.min, trial.window.max);
    show(trial, from, to);
  }

  function draw(plot) {
    if (plot.chart) plot.chart.destroy();
    plot.top.querySelectorAll(".u-legend").forEach((legend) => legend.remove());
    const values = plot.drawing.values();
    const t = plot.trial.t();
    const own = values[plot.drawing.kind === "output" ? 0 : values.length - 1];
    plot.empty = own.every((value) => value === null);      // a residual before there is a prediction
    plot.gaps = plot.drawing.kind === "input" || plot.empty ? [] : gaps(t, own);
    plot.chart = new uPlot(options(plot, onPaper() ? PRINTED : plot.box.clientWidth), [t, ...values], plot.box);
    plot.chart.setScale("x", plot.trial.window);
  }

  function place(plot) {
    const { drawing } = plot;
    const panel = document.createElement("div");
    panel.className = "panel";
    plot.top = document.createElement("div");
    plot.top.className = "top";
    const title = document.createElement("span");
    const name = document.createElement("b");
    name.textContent = drawing.title;
    title.append(name, drawing.unit === "1" ? "" : " [" + drawing.unit + "]");
    plot.top.append(title);
    plot.box = document.createElement("div");
    plot.box.style.minHeight = Math.min(PAPER[drawing.kind], plot.trial.heights[drawing.kind]) + "px";
    plot.box.setAttribute("role", "img");
    plot.box.setAttribute("aria-label", drawing.title + " of " + plot.trial.name + ", " + drawing.lines.map((l) => l.label).join(" and ") + ", against time");
    panel.append(plot.top, plot.box);
    return panel;
  }

  /* What is drawn of a trial; `beside`: with the prediction of the model before, where there is one. */
  function trialOf(data, index, heights = HEIGHTS, beside = true) {
    let t;
    const trial = { name: data.name, index, heights, beside, t: () => (t = t || clock(data.t)), plots: [] };
    const times = trial.t();
    trial.from = times.length ? times[0] : 0;
    trial.to = times.length ? times[times.length - 1] : 1;
    trial.period = (trial.to - trial.from) / Math.max(times.length - 1, 1);
    trial.window = { min: trial.from, max: trial.to };
    const all = data.panels.flatMap(drawings);
    trial.plots = all.map((drawing, k) => ({ trial, drawing, last: k === all.length - 1, gaps: [] }));
    return trial;
  }

  /* The panels into their article, empty; what stood there goes. */
  function fill(trial, article) {
    article.querySelector(".panels").replaceChildren(...trial.plots.map(place));
    trial.told = article.querySelector(".window");
  }

  /* Keys and buttons of an article act on the trial it shows at the time. */
  function listen(article, shown) {
    article.querySelector(".panels").addEventListener("keydown", (event) => pressed(event, shown()));
    article.querySelectorAll("[data-move]").forEach((button) => {
      button.addEventListener("click", () => move(shown(), button.dataset.move));
    });
  }

  function build(trial, article) {
    fill(trial, article);
    listen(article, () => trial);
  }

  /* As wide as their boxes are now. */
  function resize(plots) {
    plots.forEach((plot) => {
      const width = plot.box.clientWidth;
      if (plot.chart && !onPaper() && plot.chart.width !== width) plot.chart.setSize({ width, height: plot.chart.height });
    });
  }

  /* A stretch with half as much again on either side. */
  function around(trial, from, to) {
    show(trial, from - (to - from) / 2, to + (to - from) / 2);
  }

  /* The prediction of the model before, shown or not. */
  function setBeside(trial, beside) {
    trial.beside = beside;
    trial.plots.forEach((plot) => plot.drawing.lines.forEach((line, k) => {
      if (line.before && plot.chart) plot.chart.setSeries(k + 1, { show: beside });
    }));
  }

  return { HEIGHTS, trialOf, build, fill, listen, draw, show, tell, around, resize, setBeside };
})();
