// The states of a job, and what can be done to it in which.

export const states = ["running", "queued", "held", "interrupted", "cancelling", "done", "failed", "cancelled"];

const over = ["done", "failed", "cancelled"];
const waiting = ["queued", "running", "interrupted"];
const allowed = {
  cancel: [...waiting, "held"], hold: waiting, release: ["held"], priority: [...waiting, "held"],
  retry: ["failed", "cancelled"], extend: over, delete: over,
};

/// done, failed, cancelled: nothing happens any more, unless it is asked for.
export const isTerminal = (state) => over.includes(state);

/// Whether `action` (see above) makes sense in `state`; the service decides.
export const can = (action, state) => allowed[action].includes(state);
