/* What the page knows, and how it finds its own elements. */

export const byId = (id) => document.getElementById(id);
export const keyed = (key) => key && document.querySelector(`[data-key="${CSS.escape(key)}"]`);
export const partOf = (name) => document.querySelector(`[data-part="${CSS.escape(name)}"]`);

export const state = {
  status: null,          // the server's latest words
  version: null,         // of the pipeline file, as last heard
  screen: null,          // number of the parts on show
  html: {},              // each part as it came
  trial: null,           // name of the chosen trial
  drawn: null,           // what is plotted: {trial, name, mark}
  windows: new Map(),    // zoom by trial
  beside: true,          // the model before, in the plots
  hidden: new Set(),     // signals that are not plotted, by title
  edited: null,          // key of the control that made the last edit
  refused: null,         // {key, words} of an edit that was refused
  declined: "",          // the numbers of it: leaving the field does not send them again
  replacing: false,      // a part is being replaced
  lost: null,            // the connection: how, a name in LOST
  finished: false,       // a fit has ended, and its result is not yet said
};

export const LOST = {
  gone: "No connection to trialid. Is it still running in its terminal?",
  anew: "trialid was started anew. Open the address that it printed in its terminal.",
};

/* Asks the server; what it refuses is thrown, in its words. */
export async function answer(path, body) {
  const asked = body === undefined ? {} : {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body),
  };
  return (await ask(path, asked)).json().catch(() => ({}));
}

export async function ask(path, asked) {
  const reply = await fetch(path, { cache: "no-store", ...asked }).catch(() => { throw lost("gone"); });
  if (reply.ok) return reply;
  if (reply.status === 401) throw lost("anew");        // the token in the address is another by now
  const told = await reply.json().catch(() => ({}));
  const error = new Error(told.error || "trialid answered " + reply.status);
  error.kind = told.kind;
  throw error;
}

function lost(how) {
  state.lost = how;
  const error = new Error(LOST[how]);
  error.kind = "lost";
  return error;
}
