/**
 * The header: mode, link with its age, and who is in control.
 *
 * @import {Store} from "./store.js"
 * @import {Mode, RobotState} from "./types.js"
 */

import { byId, setText } from "./dom.js";
import { post } from "./api.js";

/** @type {Readonly<Record<Mode, readonly [string, string]>>} */
const MODES = {
  offline: ["No link", "quiet"],
  disabled: ["Disabled", "quiet"],
  unhomed: ["Not homed", "warn"],
  homing: ["Homing", "accent"],
  idle: ["Idle · homed", "ok"],
  jogging: ["Jogging", "accent"],
  moving: ["Moving", "accent"],
  running: ["Running", "accent"],
  paused: ["Paused", "warn"],
  stopping: ["Stopping", "warn"],
  fault: ["Fault", "bad"],
  estop: ["E-stop", "bad"],
};

/** Telemetry older than this is worth a warning. */
const OLD_MS = 250;
const AGE_SHOWN_MS = 500;

/** @typedef {{text: string, action: "request" | "release", label: string}} ControlChip */

/**
 * @param {RobotState["control"]} control
 * @returns {ControlChip}
 */
export function controlChip({ holder }) {
  if (holder === "you") {
    return { text: "You control", action: "release", label: "You control. Release control" };
  }
  if (holder === "another") {
    return { text: "Another controls", action: "request", label: "Another controls. Request control" };
  }
  return { text: "Control free", action: "request", label: "Control free. Request control" };
}

export class Status {
  #mode = byId("mode", HTMLElement);
  #link = byId("link", HTMLElement);
  #control = byId("control", HTMLButtonElement);
  #store;
  #ageShown = -Infinity;

  /** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
  constructor({ store, watch }) {
    this.#store = store;
    this.#control.addEventListener("click", () => {
      if (store.state === null) return;
      watch(post("control", { action: controlChip(store.state.control).action }));
    });
    store.addView(() => this.#draw());
  }

  #draw() {
    const { state, connected, stale } = this.#store;
    this.#drawMode(state, connected, stale);
    this.#control.disabled = state === null || stale;
    if (state === null) return;
    this.#drawLink(state.link, stale);
    const { text, label } = controlChip(state.control);
    setText(this.#control, text);
    this.#control.setAttribute("aria-label", label);
    this.#control.title = label;
  }

  /**
   * @param {RobotState | null} state
   * @param {boolean} connected
   * @param {boolean} stale
   */
  #drawMode(state, connected, stale) {
    const [text, tone] = !connected
      ? ["Server lost", "bad"]
      : state === null ? ["Connecting", "quiet"] : stale ? ["No news", "bad"] : MODES[state.mode];
    setText(/** @type {Element} */ (this.#mode.lastElementChild), text);
    this.#mode.dataset["tone"] = tone;
  }

  /**
   * @param {RobotState["link"]} link
   * @param {boolean} stale
   */
  #drawLink({ id, connected, phase, age_ms }, stale) {
    const old = stale || (connected ? age_ms === null || age_ms > OLD_MS : phase === "closed");
    const tone = old ? "warn" : "quiet";
    const now = performance.now();
    if (tone === this.#link.dataset["tone"] && now - this.#ageShown < AGE_SHOWN_MS) return;
    this.#ageShown = now;
    this.#link.dataset["tone"] = tone;
    const age = phase === "closed" ? "off" : !connected ? "…" : stale ? "stale" : age_ms === null ? "–" : `${Math.round(age_ms)} ms`;
    setText(/** @type {Element} */ (this.#link.lastElementChild), `${id} ${age}`);
    this.#link.title = "Link, and the age of its last news";
  }
}
