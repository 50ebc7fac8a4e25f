/* Tabs and shortcuts by keys. */

import { complain } from "./complaints.js";
import { byId, state } from "./state.js";
import { edit } from "./status.js";
import { choose, follow, rememberWindow, select } from "./trials.js";

const STEPS = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };

const TYPED = "input:not([type=checkbox]), textarea, select";

function neighbour(tabs, tab, key) {
  if (key === "Home") return tabs[0];
  if (key === "End") return tabs[tabs.length - 1];
  const step = STEPS[key];
  return step && tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length];
}

export function tabKey(event) {
  const tab = event.target.closest("[role=tab]");
  if (!tab || event.ctrlKey || event.metaKey || event.altKey) return;
  const next = neighbour([...tab.closest("[role=tablist]").querySelectorAll("[role=tab]")], tab, event.key);
  if (!next) return;
  event.preventDefault();
  next.focus();
  activate(next);
}

export function activate(tab) {
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

export const goBack = (name) => byId(name).disabled || edit("/api/" + name, {}, null);

export function shortcut(event) {
  if (event.key === "Escape") escape(event);
  if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.closest(TYPED)) return;
  const key = event.key.toLowerCase();
  const name = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
  if (!name) return;
  event.preventDefault();
  goBack(name);
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
