/**
 * What stands between a person and moving the robot, in words.
 *
 * @import {Mode, RobotState} from "./types.js"
 *
 * @typedef {{state: RobotState | null, connected: boolean, stale: boolean}} Picture
 */

/** @type {Readonly<Partial<Record<Mode, string>>>} */
const BY_MODE = {
  offline: "Connect a link first.",
  disabled: "Enable the drivers first.",
  homing: "Wait until homing ends.",
  moving: "Wait until the move ends, or stop it.",
  running: "A program runs.",
  paused: "A program is paused.",
  stopping: "Wait until the robot is at rest.",
  fault: "Reset the fault first.",
  estop: "Reset the e-stop first.",
};

/**
 * @param {Picture} picture
 * @returns {string | null} null when nothing does
 */
export function obstacleToMoving({ state, connected, stale }) {
  if (!connected) return "No connection to the server.";
  if (state === null || stale) return "No news from the robot.";
  if (state.control.holder === "another") return "Another has control of the robot.";
  return BY_MODE[state.mode] ?? null;
}

/**
 * @param {Picture} picture
 * @returns {string | null}
 */
export function obstacleToMovingThere(picture) {
  const obstacle = obstacleToMoving(picture);
  return obstacle ?? (picture.state?.homed ? null : "Home the robot first.");
}
