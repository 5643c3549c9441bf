/**
 * Set-up: the robot and the link.
 *
 * @import {Store} from "./store.js"
 */

import { get, post } from "./api.js";
import { byId, make, setText } from "./dom.js";

/** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
export function addRobotChoice({ store, watch }) {
  /** @type {HTMLSelectElement[]} */
  const selects = [...document.querySelectorAll("select")].filter((s) => "robot" in s.dataset);
  let listed = "";
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
      if (robot && document.activeElement !== select) select.value = robot;
      select.disabled = store.stale || !atRest || store.state?.control.holder === "another";
    }
    listed = names.join();
  });
}

export class LinkChoice {
  #select = byId("links", HTMLSelectElement);
  #button = byId("connect", HTMLButtonElement);

  /** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
  constructor({ store, watch }) {
    this.#button.addEventListener("click", () => {
      const connected = store.state?.link.connected;
      watch(connected ? post("disconnect") : post("connect", { link: this.#select.value }));
    });
    this.#select.addEventListener("change", () => leave(this.#select));
    store.addView(() => {
      const link = store.state?.link;
      setText(this.#button, link?.connected ? "Disconnect" : "Connect");
      const barred = store.stale || store.state?.control.holder === "another";
      this.#button.disabled = barred || !(link?.connected || this.#select.value);
      this.#select.disabled = barred || link?.connected === true;
      if (link?.connected) this.#select.value = link.id;
    });
  }

  /** Asks which links there are. */
  async refresh() {
    const { ports } = await get("ports");
    const options = ports.map((/** @type {{id: string, description: string}} */ { id, description }) =>
      make("option", { value: id }, description),
    );
    this.#select.replaceChildren(...options);
  }
}

/**
 * After a choice by pointer the arrow keys are for jogging again; who chose by keyboard stays.
 *
 * @param {HTMLSelectElement} select
 */
function leave(select) {
  if (!select.matches(":focus-visible")) select.blur();
}
