/* New content in a part's place; focus, open details, scrolling and what is being typed stay. */

import { byId, keyed, state } from "./state.js";

export function replace(place, html) {
  const kept = keep(place);
  state.replacing = true;              // a field that goes loses the focus, but nobody has left it
  place.innerHTML = html;
  state.replacing = false;
  restore(place, kept);
}

const scrollers = () => [byId("left"), byId("side"), document.scrollingElement];

function keep(place) {
  const focused = place.contains(document.activeElement) ? document.activeElement : null;
  return {
    typed: typedIn(place, focused), scrolled: [...scrollers()].map((each) => [each, each.scrollTop]),
    opened: new Map([...place.querySelectorAll("details[data-key]")].map((each) => [each.dataset.key, each.open])),
    focus: focused && (focused.dataset.key || focusKeyOf(focused)),
    range: focused && focused.selectionStart !== undefined ? [focused.selectionStart, focused.selectionEnd] : null,
    held: focused !== null,
  };
}

/* Fields not yet sent, or refused: key, what stands in them, whether it was refused. */
function typedIn(place, focused) {
  return [...place.querySelectorAll("input:not([type=checkbox])")]
    .filter((input) => input.value !== input.defaultValue && (input === focused || input.getAttribute("aria-invalid")))
    .map((input) => [input.dataset.key, input.value, input.getAttribute("aria-invalid")]);
}

/* A summary is found again by its details. */
function focusKeyOf(element) {
  const details = element.tagName === "SUMMARY" && element.parentElement;
  return details ? details.dataset.key : null;
}

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
