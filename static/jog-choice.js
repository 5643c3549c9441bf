/**
 * What a press jogs: in which frame, and held or by a step.
 *
 * @import {Frame, RobotState} from "./types.js"
 */

export class JogChoice {
  /** @type {Frame} */
  chosen = "base";
  /** @type {number | null} mm or degrees; null: held */
  chosenStep = null;

  /**
   * The frame in force: an unhomed robot moves by single joints only.
   *
   * @param {RobotState | null} state
   * @returns {Frame}
   */
  frame(state) {
    return unhomed(state) ? "joints" : this.chosen;
  }

  /**
   * Whether steps can be made: not before homing, and not in the camera's frame, of which only
   * the server knows how it lies.
   *
   * @param {RobotState | null} state
   */
  steps(state) {
    return !unhomed(state) && this.chosen !== "camera";
  }

  /**
   * The step in force; null: presses are held.
   *
   * @param {RobotState | null} state
   */
  step(state) {
    return this.steps(state) ? this.chosenStep : null;
  }
}

/** @param {RobotState | null} state */
function unhomed(state) {
  return state !== null && !state.homed;
}
