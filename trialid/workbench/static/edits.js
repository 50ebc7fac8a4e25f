/* Edits of the pipeline: buttons, boxes and fields say in data attributes what they change. */

import { complain, refuse } from "./complaints.js";
import { keyed, state } from "./state.js";
import { edit } from "./status.js";

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/* What a button asks for, one edit after the other. */
const EDITS = {
  add: (d) => d.effect.split(" ").map((effect) => ({ do: "add", effect })),
  drop: (d) => [{ do: "drop", effect: d.effect }],
  use: (d) => [{ do: "use", trial: d.trial, use: d.use }],
};

export const isEdit = (button) => Boolean(EDITS[button.dataset.do]);

export async function send(button) {
  if (button.getAttribute("aria-disabled")) return;
  button.setAttribute("aria-disabled", "true");        // a second press of the same button is the same edit
  for (const body of EDITS[button.dataset.do](button.dataset)) if (!await edit("/api/edit", body, button.dataset.key)) break;
  button.removeAttribute("aria-disabled");
}

export async function tick(box) {
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

export async function bounds(input) {
  const { parameter, key } = input.dataset;
  const ends = ["low", "high"].map((end) => keyed(end + " " + parameter));
  const [low, high] = ends.map(numberIn);
  if (low === undefined || high === undefined) return;
  await sendNumbers(ends, { do: "bounds", parameter, low, high }, key);
}

/* Bounds go as a pair: from the one field to the other nothing is sent while one of them is empty. */
export function boundsLeft(event) {
  const { dataset } = event.target;
  if (dataset.do !== "bounds" || state.replacing || !event.target.isConnected) return;
  const other = event.relatedTarget && event.relatedTarget.dataset;
  const within = other && other.do === "bounds" && other.parameter === dataset.parameter;
  if (within && !(event.target.value.trim() && event.relatedTarget.value.trim())) return;
  bounds(event.target);
}

export async function value(input) {
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

export async function addNamed(input) {
  const effect = input.value.trim();
  if (!effect) { refuse(input, "Write the name of an effect."); return; }
  const done = await edit("/api/edit", { do: "add", effect }, input.dataset.key);
  const now = keyed(input.dataset.key) || input;
  if (done) now.value = "";
  else now.setAttribute("aria-invalid", "true");
}

/* Enter in a number's field sends it; the browser fires `change` only when the field is left. */
export function entered(event) {
  const input = event.target;
  if (event.key !== "Enter" || !input.matches("input[data-do=bounds], input[data-do=value]")) return;
  event.preventDefault();
  if (input.dataset.do === "bounds") bounds(input);
  else value(input);
}
