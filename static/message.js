/**
 * The one thing to tell the operator now: what went wrong, what holds the robot back and what
 * leads out, or the next step.
 *
 * @import {Held, Mode, RobotState} from "./types.js"
 * @import {Notice, Tone} from "./notices.js"
 * @import {Picture} from "./obstacle.js"
 *
 * @typedef {"connect" | "enable" | "home" | "reset"} Step
 * @typedef {{tone: Tone, text: string, step: Step | null}} Told
 */

/** @type {Readonly<Partial<Record<Mode, Step>>>} */
const STEPS = {
  offline: "connect", disabled: "enable", unhomed: "home", fault: "reset", estop: "reset",
}; // prettier-ignore

/** @type {Readonly<Record<Mode, string>>} */
const NEXT = {
  offline: "Connect a link in Set-up.",
  disabled: "Next: enable the drivers.",
  unhomed: "Next: home. Until then only single joints move, slowly.",
  homing: "Homing: the arms seek their switches.",
  idle: "Ready. Hold a jog button, or drag the effector.",
  jogging: "Jogging. Let go to stop.",
  moving: "Moving to the target.",
  running: "A program runs.",
  paused: "The program is paused.",
  stopping: "Stopping.",
  fault: "Find the cause, then reset.",
  estop: "E-stop: the drivers are off, the homing is lost. Reset when it is safe.",
};

/** @type {ReadonlySet<Mode>} where nothing but the speed is missing when that is 0 */
const SLOWED = new Set(["idle", "jogging", "moving", "running"]);

/**
 * @param {Picture & {notice: Notice | null}} picture
 * @returns {Told}
 */
export function chooseMessage({ state, connected, stale, notice }) {
  const badNews = notice?.tone === "bad" ? notice.text : null;
  if (!connected) {
    return tell("bad", badNews ?? "No connection to the server: the numbers are old. Trying again.");
  }
  if (state === null) return tell(notice?.tone ?? "quiet", notice?.text ?? "Waiting for the robot.");
  if (stale) return tell("bad", badNews ?? "No news from the robot: the numbers are old.");
  const step = STEPS[state.mode] ?? null;
  if (badNews !== null) return tell("bad", badNews, step);
  if (state.fault !== null) return tell("bad", `Fault: ${state.fault}`, step);
  if (state.mode === "estop") return tell("bad", estopSentence(state), step);
  if (notice !== null) return tell(notice.tone, notice.text, step);
  if (state.link.problem !== null) return tell("bad", state.link.problem, step);
  if (state.held_by.length > 0) return tell("warn", heldSentence(state.held_by));
  if (state.control.holder === "another") {
    return tell("warn", "Another has control. You watch, and may stop at any time.");
  }
  const waits = state.override === 0 && SLOWED.has(state.mode);
  const tone = waits ? "warn" : "quiet";
  const todo = waits ? "The speed is 0 %: raise it to move." : (state.next_step ?? NEXT[state.mode]);
  const next = [state.link.note, todo].filter(Boolean).join(" ");
  if (state.stop_reason !== null && state.mode !== "jogging" && state.mode !== "moving") {
    return tell(tone, `Stopped: ${withPeriod(state.stop_reason)} ${next}`, step);
  }
  return tell(tone, next, step);
}

/**
 * Why, too: it may have been a button elsewhere, or the board may refuse to be reset.
 * @param {RobotState} state
 */
function estopSentence({ stop_reason, next_step }) {
  const next = next_step ?? NEXT.estop;
  return stop_reason === null ? next : `${withPeriod(stop_reason)} ${next}`;
}

/** @param {Held[]} held */
export function heldSentence(held) {
  const limits = held.map(({ limit }) => withPeriod(limit)).join(" ");
  const ways = [...new Set(held.flatMap(({ way_out }) => way_out))].map((w) =>
    w.replace("-", "\u2212"),
  );
  if (ways.length === 0) return limits;
  const list = ways.length === 1 ? ways[0] : `${ways.slice(0, -1).join(", ")} and ${ways.at(-1)}`;
  return `${limits} ${list} ${ways.length === 1 ? "leads" : "lead"} out.`;
}

/** @param {string} text */
function withPeriod(text) {
  return /[.!?]$/.test(text) ? text : `${text}.`;
}

/**
 * @param {Tone} tone
 * @param {string} text
 * @param {Step | null} [step]
 * @returns {Told}
 */
function tell(tone, text, step = null) {
  return { tone, text, step };
}
