/* The workbench: shows what the server knows and sends every edit to it. Words and names from data go in as
   text; only the parts that the server renders, where every name is escaped, go in as HTML. */
(() => {
  "use strict";

  const LOST = "No connection to trialid. Is it still running in its terminal?";

  const ABOVE = 22;                     // px a panel's heading takes
  const CLOCK = 26;                     // px of the time axis below a residual
  const AGAIN = 1000;                   // ms until the parts are asked for again
  const LEAST = 0.58, MOST = 1.2;       // of the report's sizes: a trial with two outputs fits a laptop
  const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

  const byId = (id) => document.getElementById(id);
  const keyed = (key) => key && document.querySelector(`[data-key="${CSS.escape(key)}"]`);
  const partOf = (name) => document.querySelector(`[data-part="${CSS.escape(name)}"]`);

  const state = {
    status: null,          // the server's latest words
    version: null,         // of the pipeline file, as last heard
    screen: null,          // number of the parts on show
    html: {},              // each part as it came
    trial: null,           // name of the chosen trial
    drawn: null,           // what is plotted: {trial, name, mark}
    windows: new Map(),    // zoom by trial
    beside: true,          // the model before, in the plots
    edited: null,          // key of the control that made the last edit
    refused: null,         // {key, words} of an edit that was refused
    declined: "",          // the numbers of it: leaving the field does not send them again
    replacing: false,      // a part is being replaced
    lost: false,           // the connection
  };

  /* ---- asking the server ---- */

  async function answer(path, body) {
    const asked = body === undefined ? {} : {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body),
    };
    const reply = await fetch(path, { cache: "no-store", ...asked });
    const told = await reply.json().catch(() => ({}));
    if (reply.ok) return told;
    const error = new Error(told.error || "trialid answered " + reply.status);
    error.kind = told.kind;
    throw error;
  }

  /* An edit in the name of a control; a refusal is told beside it. */
  async function edit(path, body, key) {
    state.edited = key;
    state.refused = null;
    forget(key);
    complain();
    try {
      const told = await answer(path, { version: state.version, ...body });
      hear(told);
      return true;
    } catch (error) {
      state.refused = { key, words: error.message };
      complain();
      if (error.kind === "changed") hear(await answer("/api/status"));
      return false;
    }
  }

  /* What was refused before is not asked for any more: those fields hold again what the pipeline says. */
  function forget(key) {
    const row = keyed(key) && keyed(key).closest("[data-row]");
    document.querySelectorAll("input[aria-invalid]").forEach((input) => {
      if (row && row.contains(input)) return;
      input.value = input.defaultValue;
      input.removeAttribute("aria-invalid");
    });
  }

  /* ---- what went wrong ---- */

  /* About an edit: refused, or taken back since it could not be fitted. */
  function complaint(trouble) {
    if (state.refused) return state.refused;
    return trouble && taken(trouble) ? { key: state.edited, words: trouble.words } : null;
  }

  /* Whether it is about an edit, which was taken back, and not about a file as somebody left it. */
  const taken = (trouble) => trouble.where === "fit" || trouble.words.endsWith("taken back");

  /* About an edit: beside its control where that is still there and seen; all else under the bar. */
  function complain() {
    const trouble = state.status && state.status.trouble;
    const told = complaint(trouble);
    const row = told && told.key && rowOf(told.key);
    banner(trouble && !taken(trouble) ? trouble.words : told && !row ? told.words : state.lost ? LOST : "");
    const shown = [...document.querySelectorAll(".complaint")];
    if (row && shown.length === 1 && shown[0].parentElement === row && shown[0].textContent === told.words) return;
    shown.forEach((each) => each.remove());
    if (row) complainIn(row, told.words, shown.length === 0);
  }

  function rowOf(key) {
    const control = keyed(key);
    const row = control && control.closest("[data-row]");
    return row && row.checkVisibility() ? row : null;
  }

  function complainIn(row, words, fresh) {
    const told = complaintOf(words);
    row.append(told);
    if (fresh) told.scrollIntoView({ block: "nearest" });
  }

  function complaintOf(words) {
    const told = document.createElement("p");
    told.className = "complaint";
    told.setAttribute("role", "alert");
    told.textContent = words;
    return told;
  }

  function banner(words) {
    const place = byId("banner");
    if (place.textContent !== words) place.textContent = words;
    place.hidden = !words;
  }

  /* ---- status ---- */

  function hear(status) {
    if (state.status && status.serial < state.status.serial) return;
    const before = state.status;
    state.status = status;
    state.version = status.version;
    working(status.working);
    reversible("undo", status.undo);
    reversible("redo", status.redo);
    byId("again").hidden = Boolean(status.working) || status.stage === "diagnosed";
    complain();
    announce(before, status);
    if (status.screen !== state.screen) refresh();
    else follow();
  }

  function working(now) {
    byId("working").hidden = !now;
    if (!now) return;
    byId("working-words").textContent = now.why ? now.why + ": " + now.words : now.words;
    const progress = byId("progress");
    if (now.share === null) progress.removeAttribute("value");
    else progress.value = now.share;
  }

  function reversible(name, words) {
    const button = byId(name);
    const verb = name === "undo" ? "Undo" : "Redo";
    button.disabled = !words;
    button.title = words ? verb + ": " + words : "Nothing to " + name;
    button.setAttribute("aria-label", words ? verb + ": " + words : verb);
  }

  /* For who does not see the screen: that a fit began, and what it came to. */
  function announce(before, now) {
    const [was, is] = [before && before.working, now.working];
    if (is && (!was || was.why !== is.why)) byId("said").textContent = is.why || is.words;
    if (was && !is && !now.trouble) state.finished = true;
  }

  function sayResult() {
    if (!state.finished || state.status.working) return;
    state.finished = false;
    const number = byId("error-number");
    if (number) byId("said").textContent = "Done. Error of the model: " + number.textContent.trim();
  }

  /* ---- the parts ---- */

  let fetching = false;

  async function refresh() {
    if (fetching) return;
    fetching = true;
    try {
      while (state.status.screen !== state.screen) {
        const told = await answer("/api/screen");
        state.screen = told.screen;
        show(told.parts);
        if (told.screen < state.status.screen) continue;
        break;
      }
    } catch {
      if (!state.lost) setTimeout(refresh, AGAIN);
      return;
    } finally { fetching = false; }
    sayResult();
    follow();
  }

  function show(parts) {
    const changed = Object.keys(parts).filter((name) => parts[name] !== state.html[name] && partOf(name));
    changed.forEach((name) => replace(partOf(name), parts[name]));
    Object.assign(state.html, parts);
    if (changed.includes("title")) document.title = partOf("title").querySelector("h1").textContent + " \u2013 trialid";
    choose(state.trial);
    complain();
  }

  /* New content in a part's place; focus, open details, scrolling and what is being typed stay. */
  function replace(place, html) {
    const kept = keep(place);
    state.replacing = true;              // a field that goes loses the focus, but nobody has left it
    place.innerHTML = html;
    state.replacing = false;
    restore(place, kept);
  }

  function keep(place) {
    const focused = place.contains(document.activeElement) ? document.activeElement : null;
    const typed = [...place.querySelectorAll("input:not([type=checkbox])")]
      .filter((input) => input.value !== input.defaultValue && (input === focused || input.getAttribute("aria-invalid")))
      .map((input) => [input.dataset.key, input.value, input.getAttribute("aria-invalid")]);
    return {
      typed, scrolled: [...scrollers()].map((each) => [each, each.scrollTop]),
      opened: new Map([...place.querySelectorAll("details[data-key]")].map((each) => [each.dataset.key, each.open])),
      focus: focused && (focused.dataset.key || focusKeyOf(focused)),
      range: focused && focused.selectionStart !== undefined ? [focused.selectionStart, focused.selectionEnd] : null,
      held: focused !== null,
    };
  }

  /* A summary is found again by its details. */
  function focusKeyOf(element) {
    const details = element.tagName === "SUMMARY" && element.parentElement;
    return details ? details.dataset.key : null;
  }

  const scrollers = () => [byId("left"), byId("side"), document.scrollingElement];

  function restore(place, kept) {
    place.querySelectorAll("details[data-key]").forEach((each) => {
      if (kept.opened.has(each.dataset.key)) each.open = kept.opened.get(each.dataset.key);
    });
    kept.typed.forEach(([key, value, invalid]) => {
      const input = keyed(key);
      if (!input) return;
      input.value = value;
      if (invalid) input.setAttribute("aria-invalid", invalid);
    });
    if (kept.held) refocus(place, kept);
    kept.scrolled.forEach(([each, top]) => { each.scrollTop = top; });
  }

  /* What had the focus has it again; where that is gone, as the Add of what was added, the tab above it has. */
  function refocus(place, kept) {
    const found = kept.focus && keyed(kept.focus);
    const target = found && (found.tagName === "DETAILS" ? found.querySelector("summary") : found);
    (target || fallback(place)).focus({ preventScroll: true });
    if (target && kept.range && kept.range[0] !== null && target.setSelectionRange) target.setSelectionRange(...kept.range);
  }

  function fallback(place) {
    const tab = byId(place.getAttribute("aria-labelledby"));
    if (!tab) place.tabIndex = -1;
    return tab || place;
  }

  /* ---- trials ---- */

  const trialTabs = () => [...document.querySelectorAll(".trial-tabs [role=tab]")];

  /* The tab of that name, or the first; what is not of it is hidden. */
  function choose(name) {
    const tabs = trialTabs();
    const tab = tabs.find((each) => each.dataset.trial === name) || tabs[0];
    if (!tab) return;
    state.trial = tab.dataset.trial;
    select(tabs, tab);
    tab.scrollIntoView({ block: "nearest", inline: "nearest" });
    byId("trial").setAttribute("aria-labelledby", tab.id);
    document.querySelectorAll("[data-of]").forEach((each) => { each.hidden = each.dataset.of !== state.trial; });
  }

  function select(tabs, chosen) {
    tabs.forEach((tab) => {
      tab.setAttribute("aria-selected", String(tab === chosen));
      tab.tabIndex = tab === chosen ? 0 : -1;
    });
  }

  /* The plots follow the chosen trial and the latest curves. */
  let plotting = false;

  async function follow() {
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
    const report = trialidPlots.HEIGHTS;
    const kinds = panels.flatMap((panel) => (panel.kind === "input" ? ["input"] : ["output", "residual"]));
    const fixed = kinds.length * ABOVE + kinds.filter((kind) => kind === "residual").length * CLOCK;
    const top = document.querySelector("#trial .panels").getBoundingClientRect().top + byId("left").scrollTop;
    const room = window.innerHeight - Math.min(top, 200) - fixed - 12;
    const share = room / kinds.reduce((sum, kind) => sum + report[kind], 0);
    const scale = Math.min(Math.max(share, LEAST), MOST);
    return Object.fromEntries(Object.entries(report).map(([kind, height]) => [kind, Math.round(scale * height)]));
  }

  function drawTrial(data, index) {
    const trial = trialidPlots.trialOf(data, index, heightsFor(data.panels), state.beside);
    state.drawn.trial = trial;
    document.querySelector("#trial .tools").hidden = false;
    const kept = state.windows.get(trial.name);
    if (kept && kept.min >= trial.from && kept.max <= trial.to) trial.window = kept;
    byId("beside-switch").hidden = !data.panels.some((panel) => panel.before !== undefined);
    const box = document.querySelector("#trial .panels");
    box.style.minHeight = box.offsetHeight + "px";      // else what is below jumps up and down
    trialidPlots.fill(trial, byId("trial"));
    trial.plots.forEach(trialidPlots.draw);
    trialidPlots.tell(trial);
    box.style.minHeight = "";
  }

  const shownTrial = () => (state.drawn && state.drawn.trial) || null;

  function rememberWindow() {
    const trial = shownTrial();
    if (!trial) return;
    const all = trial.window.max - trial.window.min > trial.to - trial.from - 0.5 * trial.period;
    state.windows.set(trial.name, all ? null : trial.window);
  }

  function showStretch(button) {
    const trial = shownTrial();
    if (!trial || trial.name !== button.dataset.show) return;
    trialidPlots.around(trial, Number(button.dataset.from), Number(button.dataset.to));
    const panels = document.querySelector("#trial .panels");
    byId("trial").scrollIntoView({ block: "start" });
    panels.focus({ preventScroll: true });
  }

  /* ---- tabs by keys ---- */

  const STEPS = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };

  function neighbour(tabs, tab, key) {
    if (key === "Home") return tabs[0];
    if (key === "End") return tabs[tabs.length - 1];
    const step = STEPS[key];
    return step && tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length];
  }

  function tabKey(event) {
    const tab = event.target.closest("[role=tab]");
    if (!tab || event.ctrlKey || event.metaKey || event.altKey) return;
    const next = neighbour([...tab.closest("[role=tablist]").querySelectorAll("[role=tab]")], tab, event.key);
    if (!next) return;
    event.preventDefault();
    next.focus();
    activate(next);
  }

  function activate(tab) {
    if (tab.dataset.trial !== undefined) {
      rememberWindow();
      choose(tab.dataset.trial);
      follow();
      return;
    }
    const tabs = [...document.querySelectorAll(".side-tabs [role=tab]")];
    select(tabs, tab);
    tabs.forEach((each) => { byId(each.getAttribute("aria-controls")).hidden = each !== tab; });
    complain();
  }

  /* ---- edits ---- */

  const EDITS = {
    add: (d) => ({ do: "add", effect: d.effect }),
    drop: (d) => ({ do: "drop", effect: d.effect }),
    use: (d) => ({ do: "use", trial: d.trial, use: d.use }),
  };

  function pressed(event) {
    const button = event.target.closest("button");
    if (!button) return;
    if (button.getAttribute("role") === "tab") activate(button);
    else if (button.dataset.show !== undefined) showStretch(button);
    else if (EDITS[button.dataset.do]) send(button);
  }

  async function send(button) {
    if (button.getAttribute("aria-disabled")) return;
    button.setAttribute("aria-disabled", "true");        // a second press of the same button is the same edit
    await edit("/api/edit", EDITS[button.dataset.do](button.dataset), button.dataset.key);
    button.removeAttribute("aria-disabled");
  }

  function changed(event) {
    const input = event.target;
    if (input.id === "beside") setBeside(input.checked);
    else if (input.dataset.do === "free") tick(input);
    else if (input.dataset.do === "value") value(input);
  }

  function setBeside(on) {
    state.beside = on;
    if (shownTrial()) trialidPlots.setBeside(shownTrial(), on);
  }

  async function tick(box) {
    const { parameter, key } = box.dataset;
    const done = await edit("/api/edit", { do: "free", parameter, free: box.checked }, key);
    if (!done) box.checked = box.defaultChecked;
  }

  /* A number as typed, null where the field is empty; undefined, and said beside it, where it is none. */
  function numberIn(input) {
    const text = input.value.trim().replace("\u2212", "-");
    if (text === "") return null;
    if (NUMBER.test(text)) return Number(text);
    const comma = /^[+-]?\d*,\d+$/.test(text) ? "; write it with a point: " + text.replace(",", ".") : "; write it like 0.5 or -1.2e-3";
    refuse(input, text + " is not a number" + comma);
    return undefined;
  }

  function refuse(input, words) {
    input.setAttribute("aria-invalid", "true");
    state.refused = { key: input.dataset.key, words };
    complain();
  }

  async function bounds(input) {
    const { parameter, key } = input.dataset;
    const ends = ["low", "high"].map((end) => keyed(end + " " + parameter));
    const [low, high] = ends.map(numberIn);
    if (low === undefined || high === undefined) return;
    await sendNumbers(ends, { do: "bounds", parameter, low, high }, key);
  }

  /* Bounds go as a pair: from the one field to the other nothing is sent while one of them is empty. */
  function boundsLeft(event) {
    const { dataset } = event.target;
    if (state.replacing || !event.target.isConnected) return;
    const other = event.relatedTarget && event.relatedTarget.dataset;
    const within = other && other.do === "bounds" && other.parameter === dataset.parameter;
    if (within && !(event.target.value.trim() && event.relatedTarget.value.trim())) return;
    bounds(event.target);
  }

  async function value(input) {
    const { parameter, key } = input.dataset;
    const given = numberIn(input);
    if (given !== undefined) await sendNumbers([input], { do: "value", parameter, value: given }, key);
  }

  async function sendNumbers(inputs, body, key) {
    const asked = JSON.stringify(body);
    if (state.refused && asked === state.declined) return;
    inputs.forEach((input) => input.removeAttribute("aria-invalid"));
    if (inputs.every((input) => input.value === input.defaultValue)) { settle(inputs); return; }
    state.declined = asked;
    const done = await edit("/api/edit", body, key);
    if (done) state.declined = "";
    const now = inputs.map((input) => keyed(input.dataset.key) || input);
    now.forEach((input) => { if (done) input.defaultValue = input.value; else input.setAttribute("aria-invalid", "true"); });
  }

  /* Fields that hold again what the pipeline says need no complaint. */
  function settle(inputs) {
    if (!state.refused || !inputs.some((input) => input.dataset.key === state.refused.key)) return;
    state.refused = null;
    complain();
  }

  async function submitted(event) {
    event.preventDefault();
    const form = event.target;
    if (form.id === "export-copy") await exported({ name: form.elements.name.value.trim() });
    else if (form.dataset.do === "add") await addNamed(form.elements.effect);
  }

  async function addNamed(input) {
    const effect = input.value.trim();
    if (!effect) { refuse(input, "Write the name of an effect."); return; }
    const done = await edit("/api/edit", { do: "add", effect }, input.dataset.key);
    const now = keyed(input.dataset.key) || input;
    if (done) now.value = "";
    else now.setAttribute("aria-invalid", "true");
  }

  /* ---- bar ---- */

  const back = (name) => byId(name).disabled || edit("/api/" + name, {}, null);

  async function exported(body) {
    const told = byId("exported");
    told.className = "told";
    told.textContent = "Writing \u2026";
    try {
      told.textContent = "Written:\n" + (await answer("/api/export", body)).files.join("\n");
    } catch (error) {
      told.className = "told bad";
      told.textContent = error.message;
    }
  }

  const TYPED = "input:not([type=checkbox]), textarea, select";

  function shortcut(event) {
    if (event.key === "Escape") escape(event);
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.closest(TYPED)) return;
    const key = event.key.toLowerCase();
    const name = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!name) return;
    event.preventDefault();
    back(name);
  }

  /* Escape closes the menu, and gives a field back what stood in it. */
  function escape(event) {
    const input = event.target.closest("input[data-key]");
    if (input) {
      input.value = input.defaultValue;
      input.removeAttribute("aria-invalid");
      state.refused = null;
      complain();
    }
    if (byId("export").open) {
      byId("export").open = false;
      byId("export").querySelector("summary").focus();
    }
  }

  /* Enter in a number's field sends it; the browser fires `change` only when the field is left. */
  function entered(event) {
    const input = event.target;
    if (event.key !== "Enter" || !input.matches("input[data-do=bounds], input[data-do=value]")) return;
    event.preventDefault();
    if (input.dataset.do === "bounds") bounds(input);
    else value(input);
  }

  /* ---- start ---- */

  function listen() {
    document.addEventListener("click", pressed);
    document.addEventListener("change", changed);
    document.addEventListener("focusout", (event) => { if (event.target.dataset.do === "bounds") boundsLeft(event); });
    document.addEventListener("submit", submitted);
    document.addEventListener("keydown", tabKey);
    document.addEventListener("keydown", entered);
    document.addEventListener("keydown", shortcut);
    document.addEventListener("click", (event) => { if (!event.target.closest("#export")) byId("export").open = false; });
    byId("undo").addEventListener("click", () => back("undo"));
    byId("redo").addEventListener("click", () => back("redo"));
    byId("cancel").addEventListener("click", () => answer("/api/cancel", {}).catch(() => {}));
    byId("again").addEventListener("click", () => edit("/api/again", {}, null));
    byId("export-run").addEventListener("click", () => exported({}));
  }

  function listenToPlots() {
    const nothing = { window: { min: 0, max: 1 }, from: 0, to: 1, period: 1, plots: [], told: byId("said") };
    trialidPlots.listen(byId("trial"), () => shownTrial() || nothing);
    new ResizeObserver(() => shownTrial() && trialidPlots.resize(shownTrial().plots)).observe(document.querySelector("#trial .panels"));
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => shownTrial() && shownTrial().plots.forEach(trialidPlots.draw));
  }

  function connect() {
    const events = new EventSource("/api/events");
    const found = (lost) => { if (state.lost !== lost) { state.lost = lost; complain(); } };
    // A workbench that was started anew counts from the beginning.
    events.onopen = () => { if (state.lost) Object.assign(state, { status: null, screen: null, drawn: null }); found(false); };
    events.onmessage = (event) => { found(false); hear(JSON.parse(event.data)); };
    events.onerror = () => found(true);
  }

  listen();
  listenToPlots();
  connect();
})();
