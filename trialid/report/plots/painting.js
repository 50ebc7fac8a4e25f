/* What is painted under and over the lines of a panel, in the page's own colours. */

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

/* Under the lines: where nothing was measured, and the stretches that a finding is about. */
export function shade(u, plot) {
  plot.gaps.forEach((gap) => band(u, gap, colour("gap")));
  plot.drawing.stretches.forEach((stretch) => band(u, stretch, colour("stretch")));
}

function band(u, [from, to], fill) {
  const left = Math.max(u.valToPos(from, "x", true), u.bbox.left);
  const right = Math.min(u.valToPos(to, "x", true), u.bbox.left + u.bbox.width);
  if (right <= left) return;
  u.ctx.fillStyle = fill;
  u.ctx.fillRect(left, u.bbox.top, right - left, u.bbox.height);
}

/* Under the lines, about the prediction: where 95 % of what is measured lies in a trial that was not fitted. */
export function predictionBand(u, plot) {
  const { band } = plot.drawing;
  if (!band || plot.empty) return;
  const t = u.data[0], y = u.data[u.data.length - 1];
  const [first, last] = u.series[0].idxs;
  const step = Math.max(Math.floor((last - first) / 2000), 1);
  const at = [];
  for (let k = first; k <= last; k += step) if (y[k] !== null) at.push(k);
  if (at.length < 2) return;
  const { left, top, width, height } = u.bbox;
  const point = (k, off) => u.ctx.lineTo(u.valToPos(t[k], "x", true), u.valToPos(y[k] + off, "y", true));
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(left, top, width, height);
  u.ctx.clip();
  u.ctx.beginPath();
  at.forEach((k) => point(k, band));
  at.reverse().forEach((k) => point(k, -band));
  u.ctx.globalAlpha = 0.16;
  u.ctx.fillStyle = colour("predicted");
  u.ctx.fill();
  u.ctx.restore();
}

/* Zero under the residual; over it, how far noise alone goes. */
export function zeroLine(u, plot) {
  if (plot.drawing.zero && !plot.empty) level(u, 0, []);
}

export function noiseLines(u, plot) {
  const { noise } = plot.drawing;
  if (noise) [noise, -noise].forEach((value) => level(u, value, [6, 4]));
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
