/* The chosen trial and its plots, which follow the latest curves. */

import { HEIGHTS } from "./plots/sizes.js";
import * as plots from "./plots.js";
import { draw } from "./plots/chart.js";
import { savePicture } from "./plots/picture.js";
import { choosePanels, closeMenus, fillMenu, signalsOf } from "./plots/signals.js";
import { around, isAll, listen, tell } from "./plots/zoom.js";
import { answer, byId, state } from "./state.js";

const ABOVE = 22;                     // px a panel's heading takes
const CLOCK = 26;                     // px of the time axis below a residual
const LEAST = 0.58, MOST = 1.2;       // of the report's sizes: a trial with two outputs fits a laptop

const trialTabs = () => [...document.querySelectorAll(".trial-tabs [role=tab]")];

/* The tab of that name, or the first; what is not of it is hidden. */
export function choose(name) {
  const tabs = trialTabs();
  const tab = tabs.find((each) => each.dataset.trial === name) || tabs[0];
  if (!tab) return;
  state.trial = tab.dataset.trial;
  select(tabs, tab);
  tab.scrollIntoView({ block: "nearest", inline: "nearest" });
  byId("trial").setAttribute("aria-labelledby", tab.id);
  document.querySelectorAll("[data-of]").forEach((each) => { each.hidden = each.dataset.of !== state.trial; });
}

export function select(tabs, chosen) {
  tabs.forEach((tab) => {
    tab.setAttribute("aria-selected", String(tab === chosen));
    tab.tabIndex = tab === chosen ? 0 : -1;
  });
}

let plotting = false;

export async function follow() {
  if (plotting || !state.status || state.status.stage === "reading") return;
  plotting = true;
  try {
    for (let tab = wanted(); tab && await plot(tab); tab = wanted());
  } catch { /* between two runs there may be none; the next status asks again */ } finally { plotting = false; }
}

/* What the plots depend on: the curves, and the shades and noise lines that come with the diagnosis. */
const mark = (series, stage) => series + (stage === "diagnosed" ? " diagnosed" : "");

function wanted() {
  const tab = trialTabs().find((each) => each.dataset.trial === state.trial);
  const { series, stage } = state.status;
  if (!tab) return null;
  const drawn = state.drawn && state.drawn.name === state.trial ? state.drawn.mark : "";
  const waiting = stage === "measured" && drawn.startsWith(series + " ");     // the same curves, less known of them
  return drawn === mark(series, stage) || waiting ? null : tab;
}

/* False where the curves that came are another trial's: their order has changed, and so will the parts. */
async function plot(tab) {
  const { stage } = state.status;
  const data = await answer("/api/series/" + tab.dataset.place);
  const name = tab.dataset.trial;
  if (data.name !== name) return false;
  if (state.trial !== name) return true;
  rememberWindow();
  state.drawn = { name, mark: mark(data.series, stage), trial: null };
  drawTrial(data, Number(tab.dataset.place));
  return true;
}

/* Panels as high as the pane has room for, within reason. */
function heightsFor(panels) {
  const kinds = panels.flatMap((panel) => (panel.kind === "input" ? ["input"] : ["output", "residual"]));
  const fixed = kinds.length * ABOVE + kinds.filter((kind) => kind === "residual").length * CLOCK;
  const top = document.querySelector("#trial .panels").getBoundingClientRect().top + byId("left").scrollTop;
  const room = window.innerHeight - Math.min(top, 200) - fixed - 12;
  const share = room / kinds.reduce((sum, kind) => sum + HEIGHTS[kind], 0);
  const scale = Math.min(Math.max(share, LEAST), MOST);
  return Object.fromEntries(Object.entries(HEIGHTS).map(([kind, height]) => [kind, Math.round(scale * height)]));
}

function drawTrial(data, index) {
  const trial = plots.trialOf(data, index, heightsFor(data.panels), state.beside, state.hidden);
  trial.track = () => trackOf(trial.name);
  state.drawn.trial = trial;
  document.querySelector("#trial .tools").hidden = false;
  const kept = state.windows.get(trial.name);
  if (kept && kept.min >= trial.from && kept.max <= trial.to) trial.window = kept;
  byId("beside-switch").hidden = !data.panels.some((panel) => panel.before !== undefined);
  const box = document.querySelector("#trial .panels");
  fillSignals(trial);
  box.style.minHeight = box.offsetHeight + "px";      // else what is below jumps up and down
  plots.fill(trial, byId("trial"));
  trial.plots.forEach(draw);
  tell(trial);
  box.dataset.drawn = state.drawn.mark;               // for who waits until the last curves are there
  box.style.minHeight = "";
}

function fillSignals(trial) {
  const menu = document.querySelector("#trial .signals");
  const choose = () => choosePanels(trial, state.hidden);
  fillMenu(menu, signalsOf([trial]), state.hidden, choose);
}

const trackOf = (name) => [...document.querySelectorAll("[data-of]")]
  .filter((each) => each.dataset.of === name).map((each) => each.querySelector("svg.track")).find(Boolean);

/* What was put in place of the old shows the stretch that the plots show. */
export function followAgain() {
  const trial = shownTrial();
  if (trial && trial.told) tell(trial);
}

const shownTrial = () => (state.drawn && state.drawn.trial) || null;

export function rememberWindow() {
  const trial = shownTrial();
  if (trial) state.windows.set(trial.name, isAll(trial) ? null : trial.window);
}

export function showStretch(button) {
  const trial = shownTrial();
  if (!trial || trial.name !== button.dataset.show) return;
  around(trial, Number(button.dataset.from), Number(button.dataset.to));
  const panels = document.querySelector("#trial .panels");
  byId("trial").scrollIntoView({ block: "start" });
  panels.focus({ preventScroll: true });
}

/* The prediction of the model before, shown or not. */
export function setBeside(on) {
  state.beside = on;
  if (shownTrial()) plots.setBeside(shownTrial(), on);
}

export function listenToPlots() {
  const nothing = { window: { min: 0, max: 1 }, from: 0, to: 1, period: 1, plots: [], told: byId("said") };
  listen(byId("trial"), () => shownTrial() || nothing);
  closeMenus();
  document.querySelector("#trial [data-save]").addEventListener("click", () => {
    if (shownTrial()) savePicture(shownTrial(), document.querySelector("#bar h1").textContent);
  });
  const panels = document.querySelector("#trial .panels");
  new ResizeObserver(() => shownTrial() && plots.resize(shownTrial().plots)).observe(panels);
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", () => shownTrial() && shownTrial().plots.forEach(draw));
}
