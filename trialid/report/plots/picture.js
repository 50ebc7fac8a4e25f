/* The panels of a trial that are seen, as one picture to be saved: what is on the screen, with its words. */

import { draw } from "./chart.js";
import { colour } from "./painting.js";
import { isAll } from "./zoom.js";

const TITLE = 30;                // px over the panels, for the trial and its window
const HEAD = 20;                 // px over each panel, for its name and its lines
const EDGE = 10;
const FONT = "system-ui, sans-serif";

/* Draws all that is seen onto one canvas. */
export function pictureOf(trial, title) {
  const seen = trial.plots.filter((plot) => !plot.panel.hidden);
  seen.filter((plot) => !plot.chart).forEach(draw);
  const ratio = seen.length ? seen[0].chart.ctx.canvas.width / seen[0].chart.width : 1;
  const height = seen.reduce((sum, plot) => sum + HEAD + plot.chart.height, TITLE + EDGE);
  const width = Math.max(0, ...seen.map((plot) => plot.chart.width)) + 2 * EDGE;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  const ctx = canvas.getContext("2d");
  ctx.scale(ratio, ratio);
  ctx.fillStyle = colour("paper");
  ctx.fillRect(0, 0, width, height);
  text(ctx, "ink", "600 14px", titleOf(trial, title), EDGE, 20);
  let top = TITLE;
  seen.forEach((plot) => {
    panelHead(ctx, plot, top, width);
    ctx.drawImage(plot.chart.ctx.canvas, EDGE, top + HEAD, plot.chart.width, plot.chart.height);
    top += HEAD + plot.chart.height;
  });
  return canvas;
}

function titleOf(trial, title) {
  const { min, max } = trial.window;
  const part = isAll(trial) ? "" : ", " + min.toFixed(1) + " s to " + max.toFixed(1) + " s";
  return (title ? title + ": " : "") + trial.name + part;
}

function text(ctx, ink, font, words, x, y) {
  ctx.font = font + " " + FONT;
  ctx.fillStyle = colour(ink);
  ctx.fillText(words, x, y);
  return ctx.measureText(words).width;
}

/* Name and unit on the left, a stroke and a word for each line that is shown on the right. */
function panelHead(ctx, plot, top, width) {
  const { title, unit, lines } = plot.drawing;
  const wide = text(ctx, "ink", "600 12px", title, EDGE + 52, top + 14);
  if (unit !== "1") text(ctx, "soft", "12px", " [" + unit + "]", EDGE + 52 + wide, top + 14);
  let x = width - EDGE;
  lines.map((line, k) => [line, plot.chart.series[k + 1]]).filter(([, series]) => series.show).reverse()
    .forEach(([line]) => {
      ctx.font = "12px " + FONT;
      x -= ctx.measureText(line.label).width;
      text(ctx, "soft", "12px", line.label, x, top + 14);
      ctx.fillStyle = colour(line.other || line.stroke);
      ctx.fillRect(x - 19, top + 9, 14, 3);
      x -= 34;
    });
}

/* Offers the picture as a file named by its trial. */
export function savePicture(trial, title) {
  pictureOf(trial, title).toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = (trial.name.replace(/[^\p{L}\p{N}._-]+/gu, "-") || "trial") + ".png";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}
