/**
 * Turns a press on the pad or a key into a held jog or a step.
 *
 * @import {Hands} from "./hands.js"
 * @import {JogChoice} from "./jog-choice.js"
 * @import {Notices} from "./notices.js"
 * @import {Store} from "./store.js"
 *
 * @typedef {{
 *   direction: number[],  // each entry -1, 0 or 1
 *   ofJoints?: boolean,   // of the joints, whatever the frame
 *   modifier?: string,    // the modifier key that belongs to the press
 * }} JogWish
 */

import { post } from "./api.js";
import { keyJog } from "./keymap.js";
import { obstacleToMoving } from "./obstacle.js";
import { jogVelocity } from "./robot.js";

export class Jogging {
  #store;
  #hands;
  #choice;
  #notices;

  /** @param {{store: Store, hands: Hands, choice: JogChoice, notices: Notices}} parts */
  constructor({ store, hands, choice, notices }) {
    this.#store = store;
    this.#hands = hands;
    this.#choice = choice;
    this.#notices = notices;
  }

  /**
   * @param {KeyboardEvent} event
   * @param {string} source
   * @returns {boolean} false for a key that does not jog in the present frame
   */
  key(event, source) {
    const { state, robot } = this.#store;
    if (robot === null) return false;
    const wish = keyJog(event, this.#choice.frame(state), robot);
    if (wish !== null) this.press(source, wish);
    return wish !== null;
  }

  /**
   * @param {string} source the key or pointer
   * @param {JogWish} wish
   */
  press(source, { direction, ofJoints, modifier }) {
    if (this.#hands.source !== null) return;
    const { state, robot } = this.#store;
    const obstacle = obstacleToMoving(this.#store);
    if (obstacle !== null || state === null || robot === null) {
      this.#notices.say("warn", obstacle ?? "The robot's limits are not known yet.");
      return;
    }
    const frame = ofJoints ? "joints" : this.#choice.frame(state);
    const step = this.#choice.step(state);
    if (step !== null) {
      void this.#notices.watch(this.#step(direction.map((d) => d * step), frame));
      return;
    }
    this.#notices.clear();
    const velocity = jogVelocity(robot, frame, direction, state.homed);
    this.#hands.press(source, { frame, velocity, ...(modifier && { modifier }) });
  }

  /**
   * @param {number[]} by
   * @param {import("./types.js").Frame} frame
   */
  #step(by, frame) {
    return post("jog", frame === "joints" ? { theta_deg: by } : { xyz_mm: by });
  }
}
