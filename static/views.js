/** Which view of the console shows: one jog surface at a time. */

import { byId, markPressed } from "./dom.js";

/** @typedef {"jog" | "pose" | "view" | "setup"} View */

export class Views {
  #app = byId("app", HTMLElement);
  #tabs = document.querySelectorAll(".tabs button");
  #pad = byId("pad", HTMLElement);
  #changed;
  /** What takes the jog pad's place where there is room for one of them. @type {[View, HTMLButtonElement][]} */
  #toggles = [
    ["view", byId("view-toggle", HTMLButtonElement)],
    ["setup", byId("setup-toggle", HTMLButtonElement)],
  ];

  /** @param {() => void} changed */
  constructor(changed) {
    this.#changed = changed;
    for (const [view, toggle] of this.#toggles) {
      toggle.addEventListener("click", () => this.show(this.#view === view ? "jog" : view));
    }
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
    for (const [own, toggle] of this.#toggles) {
      toggle.setAttribute("aria-expanded", String(own === view));
    }
    this.#changed();
  }
}
