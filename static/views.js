/** Which view of the console shows: one jog surface at a time. */

import { byId, markPressed } from "./dom.js";

/** @typedef {"jog" | "pose" | "setup"} View */

export class Views {
  #app = byId("app", HTMLElement);
  #toggle = byId("setup-toggle", HTMLButtonElement);
  #tabs = document.querySelectorAll(".tabs button");
  #pad = byId("pad", HTMLElement);
  #changed;

  /** @param {() => void} changed */
  constructor(changed) {
    this.#changed = changed;
    this.#toggle.addEventListener("click", () => this.show(this.#view === "setup" ? "jog" : "setup"));
    for (const tab of this.#tabs) {
      tab.addEventListener("click", () =>
        this.show(/** @type {View} */ (/** @type {HTMLElement} */ (tab).dataset["view"])),
      );
    }
  }

  get #view() {
    return /** @type {View} */ (this.#app.dataset["view"]);
  }

  /** Whether the jog pad is on the screen. */
  get jogShown() {
    return this.#pad.checkVisibility({ visibilityProperty: true });
  }

  /** @param {View} view */
  show(view) {
    this.#app.dataset["view"] = view;
    markPressed(this.#tabs, (tab) => tab.dataset["view"] === view);
    this.#toggle.setAttribute("aria-expanded", String(view === "setup"));
    this.#changed();
  }
}
