/**
 * The jog pad: frame, buttons, and step or hold.
 *
 * @import {Hands} from "./hands.js"
 * @import {JogChoice} from "./jog-choice.js"
 * @import {Store} from "./store.js"
 * @import {Frame} from "./types.js"
 * @import {Robot} from "./robot.js"
 * @import {JogWish} from "./jogging.js"
 *
 * @typedef {{text: string, label: string, hint: string, area: string, wish: JogWish}} PadButton
 */

import { byId, make, markPressed, setText } from "./dom.js";
import { inPlane } from "./keymap.js";
import { jogSpeedText, jointName } from "./robot.js";
import { obstacleToMoving } from "./obstacle.js";

/** @type {readonly (readonly [string, number, number, number, string])[]} */
const PLACES = [
  ["nw", -1, 1, 0, ""], ["n", 0, 1, 0, "↑"], ["ne", 1, 1, 0, ""],
  ["w", -1, 0, 0, "←"], ["e", 1, 0, 0, "→"],
  ["sw", -1, -1, 0, ""], ["s", 0, -1, 0, "↓"], ["se", 1, -1, 0, ""],
  ["up", 0, 0, 1, "PgUp"], ["down", 0, 0, -1, "PgDn"],
]; // prettier-ignore

const ARROWS = { nw: "↖", ne: "↗", sw: "↙", se: "↘" };

/** @type {Readonly<Record<string, readonly string[]>>} what −, + along X, Y, Z is in each frame */
const NAMES = {
  base: ["X−", "X+", "Y−", "Y+", "Z−", "Z+"],
  camera: ["Left", "Right", "Near", "Away", "Down", "Up"],
};

/**
 * Of a planar robot the pad is its plane, so that there is no column for Z.
 *
 * @param {Frame} frame
 * @param {Robot | null} robot
 * @param {number} joints
 * @returns {PadButton[]}
 */
export function padButtons(frame, robot, joints) {
  if (frame === "joints") {
    return Array.from({ length: joints }, (_, i) => i).flatMap((i) => [
      jointButton(robot, joints, i, -1),
      jointButton(robot, joints, i, 1),
    ]);
  }
  const places = robot?.planar ? PLACES.filter(([, , , z]) => z === 0) : PLACES;
  const buttons = places.map(([area, x, y, z, hint]) => {
    const direction = robot?.planar ? inPlane([x, y, z]) : [x, y, z];
    const names = direction.flatMap((d, i) =>
      d === 0 ? [] : [NAMES[frame]?.[2 * i + (d < 0 ? 0 : 1)] ?? ""],
    );
    const spoken = names.map((name, i) => (i > 0 && frame === "camera" ? name.toLowerCase() : name));
    const text = ARROWS[/** @type {keyof typeof ARROWS} */ (area)] ?? names.join("");
    return { text, label: spoken.join(" and "), hint, area, wish: { direction } };
  });
  if (!robot?.toolAxis) return buttons;
  const turning = { ...jointButton(robot, joints, joints - 1, 1), text: "↺ +", hint: "R", area: "ccw" };
  const back = { ...jointButton(robot, joints, joints - 1, -1), text: "↻ −", hint: "⇧ R", area: "cw" };
  return [...buttons, turning, back];
}

/**
 * @param {Robot | null} robot
 * @param {number} joints
 * @param {number} joint 0-based
 * @param {1 | -1} sign
 * @returns {PadButton}
 */
function jointButton(robot, joints, joint, sign) {
  const turnsTool = robot?.toolAxis && joint === joints - 1;
  const [who, back, forth] = turnsTool
    ? ["Tool", "clockwise", "counter-clockwise"]
    : [`Joint ${joint + 1}`, "up", "down"];
  const direction = Array(joints).fill(0);
  direction[joint] = sign;
  return {
    text: `${jointName(robot, joint)} ${sign < 0 ? "−" : "+"}`,
    label: `${who} ${sign < 0 ? `−, ${back}` : `+, ${forth}`}`,
    hint: sign < 0 ? `⇧ ${joint + 1}` : `${joint + 1}`,
    area: "",
    wish: { direction, ofJoints: true },
  };
}

export class JogPad {
  #pad = byId("pad", HTMLElement);
  #frames = byId("frames", HTMLElement).querySelectorAll("button");
  #steps = byId("steps", HTMLElement).querySelectorAll("button");
  #toolKeys = byId("tool-keys", HTMLElement);
  #depthKeys = byId("depth-keys", HTMLElement);
  #store;
  #hands;
  #choice;
  #press;
  #built = "";

  /**
   * @param {{
   *   store: Store, hands: Hands, choice: JogChoice,
   *   press: (source: string, wish: JogWish) => void,
   * }} parts `press` begins a jog, or makes a step
   */
  constructor({ store, hands, choice, press }) {
    this.#store = store;
    this.#hands = hands;
    this.#choice = choice;
    this.#press = press;
    for (const button of this.#frames) {
      button.addEventListener("click", () =>
        this.#choose(() => (choice.chosen = /** @type {Frame} */ (button.dataset["frame"]))),
      );
    }
    for (const button of this.#steps) {
      button.addEventListener("click", () =>
        this.#choose(() => (choice.chosenStep = Number(button.dataset["step"]) || null)),
      );
    }
    this.#pad.addEventListener("contextmenu", (event) => event.preventDefault());
    store.addView(() => this.#draw());
  }

  get #step() {
    return this.#choice.step(this.#store.state);
  }

  /** @param {() => void} change */
  #choose(change) {
    this.#hands.endJog();
    change();
    this.#store.changed();
  }

  #draw() {
    const { state, robot } = this.#store;
    const frame = this.#choice.frame(state);
    const joints = robot?.joints ?? state?.theta_deg?.length ?? 3;
    this.#build(frame, robot, joints);
    this.#toolKeys.hidden = !robot?.toolAxis;
    setText(this.#depthKeys, robot?.planar ? "Z, up and down" : "Y, or away and near");
    const unhomed = frame !== this.#choice.chosen;
    for (const button of this.#frames) button.disabled = unhomed && button.dataset["frame"] !== frame;
    markPressed(this.#frames, (b) => b.dataset["frame"] === frame);
    const step = this.#choice.step(state);
    for (const button of this.#steps) button.disabled = !this.#choice.steps(state) && button.dataset["step"] !== "";
    markPressed(this.#steps, (b) => (Number(b.dataset["step"]) || null) === step);
    const units = frame === "joints" ? "°" : robot?.toolAxis ? "mm, °" : "mm";
    setText(byId("step-label", HTMLElement), `Step ${units}`);
    const speed = byId("jog-speed", HTMLElement);
    if (robot && state) setText(speed, jogSpeedText(robot, frame, state.homed, state.override));
    this.#pad.toggleAttribute("data-barred", obstacleToMoving(this.#store) !== null);
    this.#drawHeld();
  }

  #drawHeld() {
    const held = this.#hands.velocity?.map(Math.sign).join();
    for (const button of this.#pad.querySelectorAll("button")) {
      button.toggleAttribute("data-held", held !== undefined && button.dataset["direction"] === held);
    }
  }

  /**
   * @param {Frame} frame
   * @param {Robot | null} robot
   * @param {number} joints
   */
  #build(frame, robot, joints) {
    const shape = frame === "joints" ? "joints" : robot?.planar ? "plane" : robot?.toolAxis ? "tool" : "space";
    const built = `${frame} ${shape} ${robot?.jointNames.join() ?? joints}`;
    if (built === this.#built) return;
    this.#built = built;
    this.#hands.endJog();
    this.#pad.dataset["frame"] = frame === "joints" ? "joints" : "cartesian";
    this.#pad.dataset["shape"] = shape;
    this.#pad.dataset["joints"] = String(joints);
    this.#pad.replaceChildren(...padButtons(frame, robot, joints).map((button) => this.#make(button)));
  }

  /** @param {PadButton} button */
  #make({ text, label, hint, area, wish }) {
    const element = make("button", { type: "button", "aria-label": label }, make("b", {}, text));
    element.dataset["direction"] = wish.direction.join();
    if (area) element.dataset["area"] = area;
    if (hint) element.append(make("kbd", {}, hint));
    this.#listen(element, wish);
    return element;
  }

  /**
   * @param {HTMLButtonElement} button
   * @param {JogWish} wish
   */
  #listen(button, wish) {
    button.addEventListener("pointerdown", (event) => {
      if (this.#step !== null || event.button !== 0) return;
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      button.setPointerCapture(event.pointerId);
      this.#press(`pointer:${event.pointerId}`, wish);
    });
    for (const type of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
      button.addEventListener(type, (event) => this.#hands.release(`pointer:${event.pointerId}`));
    }
    button.addEventListener("click", () => {
      if (this.#step !== null) this.#press("click", wish);
    });
    button.addEventListener("keydown", (event) => {
      if (event.key !== " " && event.key !== "Enter") return;
      if (event.repeat || event.ctrlKey || event.altKey || event.metaKey) event.preventDefault();
      else if (this.#step === null) this.#press(`key:${event.code}`, wish);
    });
  }
}
