/* The panels of a trial as drawn: what each shows, not yet how. */

import { difference, numbers } from "./numbers.js";

const BEFORE = { label: "model before", stroke: "second", width: 1.2, before: true };

/* An output is two panels, the residual below. */
export function drawings(panel) {
  if (panel.kind === "input") return [inputDrawing(panel)];
  if (panel.kind === "overlay") return overlayDrawings(panel);
  let values;
  const read = () => (values = values || outputValues(panel));
  const before = panel.before === undefined ? [] : [BEFORE];
  return [outputDrawing(panel, before, read), residualDrawing(panel, before, read)];
}

function outputDrawing(panel, before, read) {
  return {
    kind: "output", title: panel.title, unit: panel.unit, stretches: panel.stretches, band: panel.band,
    lines: [
      { label: "measured", stroke: "measured", width: 1 },
      ...before.map((line) => ({ ...line, dash: [5, 4] })),
      { label: "predicted", stroke: "predicted", width: 1.8 },
    ],
    values: () => [read().measured, ...read().before, read().predicted],
  };
}

function residualDrawing(panel, before, read) {
  return {
    kind: "residual", title: "residual of " + panel.symbol, unit: panel.unit, stretches: panel.stretches,
    zero: true, noise: panel.noise,
    lines: [...before, { label: "measured \u2212 predicted", stroke: "residual", width: 1 }],
    values: () => [
      ...read().before.map((predicted) => difference(read().measured, predicted)),
      read().residual,
    ],
  };
}

function inputDrawing(panel) {
  const strokes = ["predicted", "second", "residual", "measured"];
  return {
    kind: "input", title: panel.title, unit: panel.unit, stretches: [],
    lines: panel.lines.map((line, k) => ({
      label: line.label, stroke: "measured", width: 1.2, other: k > 0 ? strokes[k % 4] : null,
    })),
    values: () => panel.lines.map((line) => numbers(line.data)),
  };
}

const PALETTE = ["predicted", "model", "residual", "second", "soft"];

/* Of several runs: their predictions over what was measured, and below what each leaves. */
function overlayDrawings(panel) {
  let values;
  const read = () => (values = values || {
    measured: numbers(panel.measured), runs: panel.runs.map((run) => numbers(run.data)),
  });
  const lines = panel.runs.map((run, k) => ({
    label: run.label, stroke: PALETTE[k % PALETTE.length], width: 1.4, dash: k < PALETTE.length ? undefined : [5, 4],
  }));
  const shared = { unit: panel.unit, stretches: [] };
  return [
    { ...shared, kind: "output", title: panel.title, lines: [{ label: "measured", stroke: "measured", width: 1 }, ...lines],
      values: () => [read().measured, ...read().runs] },
    { ...shared, kind: "residual", title: "residual of " + panel.symbol, zero: true, lines: lines.map((line) => ({ ...line, width: 1 })),
      values: () => read().runs.map((predicted) => difference(read().measured, predicted)) },
  ];
}

function outputValues(panel) {
  const measured = numbers(panel.measured);
  const predicted = numbers(panel.predicted);
  const before = panel.before === undefined ? [] : [numbers(panel.before)];
  return { measured, predicted, before, residual: difference(measured, predicted) };
}
