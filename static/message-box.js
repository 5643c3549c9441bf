/**
 * The message box: always there and always as high, so that nothing jumps.
 *
 * @import {Store} from "./store.js"
 * @import {Notices} from "./notices.js"
 * @import {Step} from "./message.js"
 */

import { byId, setText } from "./dom.js";
import { chooseMessage } from "./message.js";

/** @type {Readonly<Record<Step, string>>} */
const LABELS = { connect: "Set-up", enable: "Enable", home: "Home", reset: "Reset" };

/** Characters beyond which a text is set smaller, so that it fits. */
const LONG = 80;

export class MessageBox {
  #box = byId("message", HTMLElement);
  #text = byId("message-text", HTMLElement);
  #button = byId("message-step", HTMLButtonElement);
  /** @type {Step | null} */
  #step = null;

  /**
   * @param {{store: Store, notices: Notices, steps: Readonly<Record<Step, () => void>>}} parts
   */
  constructor({ store, notices, steps }) {
    this.#button.addEventListener("click", () => {
      if (this.#step !== null) steps[this.#step]();
    });
    store.addView(() => {
      const { state, connected, stale } = store;
      const told = chooseMessage({ state, connected, stale, notice: notices.current });
      setText(this.#text, told.text);
      this.#box.dataset["tone"] = told.tone;
      this.#box.toggleAttribute("data-long", told.text.length > LONG);
      this.#step = told.step;
      this.#button.hidden = told.step === null || state?.control.holder === "another";
      if (told.step !== null) setText(this.#button, LABELS[told.step]);
    });
  }
}
