/**
 * What a press jogs: in which frame, and held or by a step.
 *
 * @import {Frame, RobotState} from "./types.js"
 */

export class JogChoice {
  /** @type {Frame} */
  chosen = "base";
  /** @type {number | null} mm or degrees; null: held */
  step = null;

  /**
   * The frame in force: an unhomed robot moves by single joints only.
   *
   * @param {RobotState | null} state
   * @returns {Frame}
   */
  frame(state) {
    return state !== null && state.mode === "unhomed" ? "joints" : this.chosen;
  }
}
