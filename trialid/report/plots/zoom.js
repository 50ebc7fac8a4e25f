/* The window of a trial: all its panels show the same stretch of time, and so does its track. */

import { followTrack } from "./track.js";

const KEYS = { ArrowLeft: "earlier", ArrowRight: "later", "+": "closer", "=": "closer", "-": "wider", "0": "all" };

const MOVES = {
  earlier: (from, to) => [from - 0.5 * (to - from), to - 0.5 * (to - from)],
  later: (from, to) => [from + 0.5 * (to - from), to + 0.5 * (to - from)],
  closer: (from, to) => [from + 0.25 * (to - from), to - 0.25 * (to - from)],
  wider: (from, to) => [from - 0.5 * (to - from), to + 0.5 * (to - from)],
  all: () => [-Infinity, Infinity],
};

export function show(trial, from, to) {
  const least = 5 * trial.period;
  const width = Math.min(Math.max(to - from, least), trial.to - trial.from);
  const start = Math.min(Math.max(from, trial.from), trial.to - width);
  trial.window = { min: start, max: start + width };
  trial.plots.forEach((plot) => plot.chart && plot.chart.setScale("x", trial.window));
  tell(trial);
}

export const showAll = (trial) => show(trial, trial.from, trial.to);

export function isAll(trial) {
  const { min, max } = trial.window;
  return max - min > trial.to - trial.from - 0.5 * trial.period;
}

/* The window in words, for eyes and for screen readers. */
export function tell(trial) {
  const { min, max } = trial.window;
  trial.told.textContent = isAll(trial) ? "" : min.toFixed(1) + " s to " + max.toFixed(1) + " s";
  const track = trial.track && trial.track();
  if (track) followTrack(track, min, max, isAll(trial));
}

/* A stretch with half as much again on either side. */
export function around(trial, from, to) {
  show(trial, from - (to - from) / 2, to + (to - from) / 2);
}

/* A stretch dragged over becomes the window of the whole trial. */
export function choose(u, trial) {
  const { left, width } = u.select;
  if (width < 4) return;
  const [from, to] = [u.posToVal(left, "x"), u.posToVal(left + width, "x")];
  u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  show(trial, from, to);
}

/* Keys and buttons of an article act on the trial it shows at the time. */
export function listen(article, shown) {
  article.querySelector(".panels").addEventListener("keydown", (event) => pressed(event, shown()));
  article.querySelectorAll("[data-move]").forEach((button) => {
    button.addEventListener("click", () => move(shown(), button.dataset.move));
  });
}

function pressed(event, trial) {
  const name = KEYS[event.key];
  if (!name || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  move(trial, name);
}

function move(trial, name) {
  const [from, to] = MOVES[name](trial.window.min, trial.window.max);
  show(trial, from, to);
}
