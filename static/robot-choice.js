/**
 * Set-up: the robot.
 *
 * @import {Store} from "./store.js"
 */

import { post } from "./api.js";
import { leave, make } from "./dom.js";

/** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
export function addRobotChoice({ store, watch }) {
  /** @type {HTMLSelectElement[]} */
  const selects = [...document.querySelectorAll("select")].filter((s) => "robot" in s.dataset);
  let listed = "";
  /** @type {string | undefined} */
  let shown;
  for (const select of selects) {
    select.addEventListener("change", () => {
      const robot = select.value;
      select.value = store.state?.robot ?? robot;
      leave(select);
      watch(post("robot", { robot }));
    });
  }
  store.addView(() => {
    const robot = store.state?.robot;
    const names = [...new Set([...(store.robot?.presets ?? []), ...(robot ? [robot] : [])])];
    const atRest = ["offline", "disabled", "unhomed", "idle"].includes(store.state?.mode ?? "");
    for (const select of selects) {
      if (listed !== names.join()) {
        select.replaceChildren(...names.map((name) => make("option", { value: name }, name)));
      }
      // Who looks through the list is not disturbed, unless what is driven changes.
      if (robot && (robot !== shown || document.activeElement !== select)) select.value = robot;
      select.disabled = store.stale || !atRest || store.state?.control.holder === "another";
    }
    listed = names.join();
    shown = robot;
  });
}
