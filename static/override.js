/**
 * The feed override. Its slider shows what the controller has, except while it is held.
 *
 * @import {Connection} from "./connection.js"
 * @import {Store} from "./store.js"
 */

import { byId, setText } from "./dom.js";
import { Echo, paced } from "./slider.js";

/** @param {{store: Store, connection: Connection}} parts */
export function addOverride({ store, connection }) {
  const slider = byId("override", HTMLInputElement);
  const text = byId("override-text", HTMLElement);
  const echo = new Echo();
  let held = false;

  const send = paced(() => connection.send({ type: "override", value: Number(slider.value) / 100 }));
  const show = () => setText(text, `${slider.value} %`);
  slider.addEventListener("pointerdown", () => (held = true));
  slider.addEventListener("input", () => {
    echo.touch();
    show();
    send();
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
    if (state === null || held || !echo.over) return;
    const value = String(Math.round(state.override * 100));
    if (slider.value !== value) slider.value = value;
    show();
  });
}
