/**
 * Enable or Disable or Reset, whichever the mode allows, and Home. There is one pair of buttons
 * for each layout.
 *
 * @import {Store} from "./store.js"
 * @import {Mode} from "./types.js"
 */

import { post } from "./api.js";
import { setText } from "./dom.js";

/** @typedef {"enable" | "disable" | "reset"} PowerAction */

/** @type {Readonly<Record<PowerAction, string>>} */
const LABELS = { enable: "Enable", disable: "Disable", reset: "Reset" };

/** @type {ReadonlySet<Mode>} */
const HOMEABLE = new Set(["unhomed", "idle"]);
/** @type {ReadonlySet<Mode>} */
const DISABLEABLE = new Set(["unhomed", "idle"]);

/**
 * @param {Mode} mode
 * @returns {PowerAction}
 */
export function powerAction(mode) {
  if (mode === "fault" || mode === "estop") return "reset";
  return mode === "offline" || mode === "disabled" ? "enable" : "disable";
}

/** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
export function addPower({ store, watch }) {
  /** @type {HTMLButtonElement[]} */
  const powers = [...document.querySelectorAll("button")].filter((b) => "power" in b.dataset);
  /** @type {HTMLButtonElement[]} */
  const homes = [...document.querySelectorAll("button")].filter((b) => "home" in b.dataset);
  for (const button of powers) {
    button.addEventListener("click", () => watch(post(/** @type {string} */ (button.dataset["power"]))));
  }
  for (const button of homes) button.addEventListener("click", () => watch(post("home")));
  store.addView(() => {
    const mode = store.state?.mode ?? "offline";
    const barred = store.stale || store.state?.control.holder === "another";
    const action = powerAction(mode);
    const possible = action === "disable" ? DISABLEABLE.has(mode) : mode !== "offline";
    for (const button of powers) {
      setText(button, LABELS[action]);
      button.dataset["power"] = action;
      button.disabled = barred || !possible;
    }
    for (const button of homes) button.disabled = barred || !HOMEABLE.has(mode);
  });
}
