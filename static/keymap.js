/**
 * Which key jogs where. Keys are named by their place on the keyboard (`event.code`).
 *
 * @import {Frame} from "./types.js"
 * @import {Robot} from "./robot.js"
 * @import {JogWish} from "./jogging.js"
 */

/** @type {Readonly<Record<string, readonly [number, number, number]>>} */
const CARTESIAN = {
  ArrowRight: [1, 0, 0], KeyD: [1, 0, 0],
  ArrowLeft: [-1, 0, 0], KeyA: [-1, 0, 0],
  ArrowUp: [0, 1, 0], KeyW: [0, 1, 0],
  ArrowDown: [0, -1, 0], KeyS: [0, -1, 0],
  PageUp: [0, 0, 1], KeyQ: [0, 0, 1],
  PageDown: [0, 0, -1], KeyE: [0, 0, -1],
}; // prettier-ignore

/** Turns a tool that turns, in every frame. */
const TOOL = "KeyR";

/**
 * @param {{code: string, shiftKey: boolean}} event
 * @param {Frame} frame
 * @param {Robot} robot
 * @returns {JogWish | null} null for a key that does not jog this robot in this frame
 */
export function keyJog({ code, shiftKey }, frame, robot) {
  if (code === TOOL && robot.toolAxis) return jointJog(robot, robot.joints - 1, shiftKey);
  if (frame !== "joints") {
    const direction = CARTESIAN[code];
    return direction ? { direction: robot.planar ? inPlane(direction) : [...direction] } : null;
  }
  const joint = Number(/^(?:Digit|Numpad)([1-9])$/.exec(code)?.[1] ?? 0);
  return joint < 1 || joint > robot.joints ? null : jointJog(robot, joint - 1, shiftKey);
}

/**
 * A robot without Y is jogged as it is seen: what leads away elsewhere leads up.
 *
 * @param {readonly [number, number, number]} direction
 */
export function inPlane([x, y, z]) {
  return [x, 0, y + z];
}

/**
 * @param {Robot} robot
 * @param {number} joint 0-based
 * @param {boolean} shift backwards
 * @returns {JogWish}
 */
function jointJog(robot, joint, shift) {
  const direction = Array(robot.joints).fill(0);
  direction[joint] = shift ? -1 : 1;
  return { direction, ofJoints: true, ...(shift && { modifier: "Shift" }) };
}

/**
 * Whether the console has a use for the key in any frame: such keys are kept from viser, whose
 * camera they would move.
 *
 * @param {string} code
 */
export function isConsoleKey(code) {
  return code in CARTESIAN || code === TOOL || /^(?:Digit|Numpad)[1-9]$/.test(code);
}

/**
 * Whether the element needs the keys for itself. Elements of the frame belong to another
 * window, so `instanceof` would not know them.
 *
 * @param {EventTarget | null} target
 */
export function takesKeys(target) {
  return isTextField(target) || matches(target, "select, input[type=range], [role=slider]");
}

/** @param {EventTarget | null} target */
export function isTextField(target) {
  return matches(
    target,
    "textarea, [contenteditable]:not([contenteditable=false]), [role=combobox]," +
      "input:not([type=button], [type=checkbox], [type=radio], [type=range], [type=submit])",
  );
}

/**
 * @param {EventTarget | null} target
 * @param {string} selector
 */
function matches(target, selector) {
  const element = /** @type {Element | null} */ (target);
  return typeof element?.matches === "function" && element.matches(selector);
}
