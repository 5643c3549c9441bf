/**
 * What the page needs to know of the robot that is driven.
 *
 * @import {Frame} from "./types.js"
 *
 * @typedef {readonly [number, number]} Range
 *
 * @typedef {{
 *   name: string,
 *   joints: number,
 *   jointNames: string[],
 *   planar: boolean,          // it has no Y
 *   toolAxis: boolean,        // the last joint turns the tool
 *   presets: string[],
 *   angles: Range[],          // degrees, one per joint
 *   axes: (Range | null)[],   // mm, X Y Z; null for one that it does not have
 *   speed: number,            // mm/s, the limit
 *   jointSpeeds: number[],    // degrees/s, the limits
 *   unhomedSpeeds: number[],  // degrees/s, the limits before homing
 * }} Robot
 */

/** A held jog at 100 % moves at this share of the robot's limits. */
const JOG_SHARE = 0.25;

/**
 * @param {any} answer of GET /api/robot
 * @returns {Robot}
 */
export function readRobot(answer) {
  const joints = Number(answer.joints);
  const { joint, cartesian } = answer.limits;
  const [low, high] = answer.workspace.z;
  const around = answer.workspace.radius ?? Math.abs(low);
  const planar = !answer.axes.includes("Y");
  return {
    name: answer.name,
    joints,
    jointNames: answer.joint_names,
    planar,
    toolAxis: answer.tool_axis,
    presets: answer.presets,
    angles: pairs(joint.min_deg, joint.max_deg, joints),
    axes: [
      answer.workspace.x ?? [-around, around],
      planar ? null : (answer.workspace.y ?? [-around, around]),
      [low, high],
    ],
    speed: cartesian.velocity,
    jointSpeeds: each(joint.velocity_deg_s, joints),
    unhomedSpeeds: each(joint.unhomed_velocity_deg_s, joints),
  };
}

export const AXES = ["X", "Y", "Z"];

/**
 * @param {Robot | null} robot
 * @param {number} axis 0 to 2
 */
export function hasAxis(robot, axis) {
  return robot === null || robot.axes[axis] !== null;
}

/**
 * @param {Robot | null} robot
 * @param {number} joint 0-based
 */
export function jointName(robot, joint) {
  return robot?.jointNames[joint] ?? `θ${joint + 1}`;
}

/**
 * The velocity of a held jog: mm/s, or degrees/s for joints. Diagonals are no faster.
 *
 * @param {Robot} robot
 * @param {Frame} frame
 * @param {number[]} direction each entry -1, 0 or 1
 * @param {boolean} homed
 * @returns {number[]}
 */
export function jogVelocity(robot, frame, direction, homed) {
  if (frame === "joints") {
    const speeds = homed ? robot.jointSpeeds.map((v) => v * JOG_SHARE) : robot.unhomedSpeeds;
    return direction.map((d, i) => d * (speeds[i] ?? 0));
  }
  const length = Math.hypot(...direction);
  return direction.map((d) => (d / length) * robot.speed * JOG_SHARE);
}

/**
 * The speed of a held jog at the feed override, for a person.
 *
 * @param {Robot} robot
 * @param {Frame} frame
 * @param {boolean} homed
 * @param {number} override
 */
export function jogSpeedText(robot, frame, homed, override) {
  const ofJoints = frame === "joints";
  const direction = ofJoints ? Array(robot.joints).fill(1) : [1];
  const speeds = jogVelocity(robot, frame, direction, homed).map((speed) => speed * override);
  const shown = [Math.min(...speeds), Math.max(...speeds)].map((v) => v.toFixed(v < 10 ? 1 : 0));
  return `${[...new Set(shown)].join("–")} ${ofJoints ? "°/s" : "mm/s"}`;
}

/**
 * @param {number | number[]} value one number for all, or one each
 * @param {number} n
 * @returns {number[]}
 */
function each(value, n) {
  return Array.isArray(value) ? value : Array(n).fill(value);
}

/**
 * @param {number | number[]} low
 * @param {number | number[]} high
 * @param {number} n
 * @returns {Range[]}
 */
function pairs(low, high, n) {
  const highs = each(high, n);
  return each(low, n).map((value, i) => [value, highs[i] ?? value]);
}
