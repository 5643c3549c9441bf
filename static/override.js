/**
 * The feed override. Its slider shows what the controller has, except while it is held.
 *
 * @import {Connection} from "./connection.js"
 * @import {Store} from "./store.js"
 */

import { byId, setText } from "./dom.js";

/** Between two messages while the slider moves; the last value always goes. */
const PAUSE_MS = 50;
/** How long the controller may take to report a new value. */
const ECHO_MS = 600;

/** @param {{store: Store, connection: Connection}} parts */
export function addOverride({ store, connection }) {
  const slider = byId("override", HTMLInputElement);
  const text = byId("override-text", HTMLElement);
  let touched = -Infinity;
  let held = false;
  /** @type {number | undefined} */
  let waiting;

  const send = () => {
    waiting = undefined;
    connection.send({ type: "override", value: Number(slider.value) / 100 });
  };
  const show = () => setText(text, `${slider.value} %`);
  slider.addEventListener("pointerdown", () => (held = true));
  slider.addEventListener("input", () => {
    touched = performance.now();
    show();
    waiting ??= setTimeout(send, PAUSE_MS);
  });
  for (const type of ["pointerup", "pointercancel", "lostpointercapture"]) {
    slider.addEventListener(type, () => {
      held = false;
      // Else the arrow keys would go on turning the speed instead of jogging.
      slider.blur();
    });
  }
  store.addView(() => {
    const { state } = store;
    slider.disabled = store.stale || state?.control.holder === "another";
    if (state === null || held || performance.now() - touched < ECHO_MS) return;
    const value = String(Math.round(state.override * 100));
    if (slider.value !== value) slider.value = value;
    show();
  });
}
