/**
 * The jog pad: frame, buttons, and step or hold.
 *
 * @import {Hands} from "./hands.js"
 * @import {JogChoice} from "./jog-choice.js"
 * @import {Store} from "./store.js"
 * @import {Frame} from "./types.js"
 *
 * @typedef {{text: string, label: string, hint: string, area: string, direction: number[]}} PadButton
 */

import { byId, make, markPressed, setText } from "./dom.js";
import { jogSpeedText } from "./robot.js";
import { obstacleToMoving } from "./obstacle.js";

/** @type {readonly (readonly [string, number, number, number, string])[]} */
const PLACES = [
  ["nw", -1, 1, 0, ""], ["n", 0, 1, 0, "↑"], ["ne", 1, 1, 0, ""],
  ["w", -1, 0, 0, "←"], ["e", 1, 0, 0, "→"],
  ["sw", -1, -1, 0, ""], ["s", 0, -1, 0, "↓"], ["se", 1, -1, 0, ""],
  ["up", 0, 0, 1, "PgUp"], ["down", 0, 0, -1, "PgDn"],
]; // prettier-ignore

/** @type {Readonly<Record<string, readonly [string, string]>>} the names in each frame */
const NAMES = {
  nw: ["↖", "↖"], n: ["Y+", "Away"], ne: ["↗", "↗"],
  w: ["X−", "Left"], e: ["X+", "Right"],
  sw: ["↙", "↙"], s: ["Y−", "Near"], se: ["↘", "↘"],
  up: ["Z+", "Up"], down: ["Z−", "Down"],
}; // prettier-ignore

/** @type {Readonly<Record<string, readonly [string, string]>>} spoken names of the diagonals */
const DIAGONALS = {
  nw: ["X− and Y+", "Left and away"], ne: ["X+ and Y+", "Right and away"],
  sw: ["X− and Y−", "Left and near"], se: ["X+ and Y−", "Right and near"],
}; // prettier-ignore

/**
 * @param {Frame} frame
 * @param {number} joints
 * @returns {PadButton[]}
 */
export function padButtons(frame, joints) {
  if (frame === "joints") return jointButtons(joints);
  const naming = frame === "base" ? 0 : 1;
  return PLACES.map(([area, x, y, z, hint]) => {
    const text = NAMES[area]?.[naming] ?? "";
    return { text, label: DIAGONALS[area]?.[naming] ?? text, hint, area, direction: [x, y, z] };
  });
}

/**
 * @param {number} joints
 * @returns {PadButton[]}
 */
function jointButtons(joints) {
  return Array.from({ length: joints }, (_, i) => i).flatMap((i) =>
    [-1, 1].map((sign) => ({
      text: `θ${i + 1} ${sign < 0 ? "−" : "+"}`,
      label: `Joint ${i + 1} ${sign < 0 ? "−, up" : "+, down"}`,
      hint: sign < 0 ? `⇧ ${i + 1}` : `${i + 1}`,
      area: "",
      direction: Array.from({ length: joints }, (_unused, j) => (j === i ? sign : 0)),
    })),
  );
}

export class JogPad {
  #pad = byId("pad", HTMLElement);
  #frames = byId("frames", HTMLElement).querySelectorAll("button");
  #steps = byId("steps", HTMLElement).querySelectorAll("button");
  #store;
  #hands;
  #choice;
  #press;
  #built = "";

  /**
   * @param {{
   *   store: Store, hands: Hands, choice: JogChoice,
   *   press: (source: string, direction: number[]) => void,
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
    this.#build(frame, joints);
    const unhomed = frame !== this.#choice.chosen;
    for (const button of this.#frames) button.disabled = unhomed && button.dataset["frame"] !== frame;
    markPressed(this.#frames, (b) => b.dataset["frame"] === frame);
    const step = this.#choice.step(state);
    for (const button of this.#steps) button.disabled = !this.#choice.steps(state) && button.dataset["step"] !== "";
    markPressed(this.#steps, (b) => (Number(b.dataset["step"]) || null) === step);
    setText(byId("step-label", HTMLElement), frame === "joints" ? "Step °" : "Step mm");
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
   * @param {number} joints
   */
  #build(frame, joints) {
    const built = `${frame} ${joints}`;
    if (built === this.#built) return;
    this.#built = built;
    this.#hands.endJog();
    this.#pad.dataset["frame"] = frame === "joints" ? "joints" : "cartesian";
    this.#pad.dataset["joints"] = String(joints);
    this.#pad.replaceChildren(...padButtons(frame, joints).map((button) => this.#make(button)));
  }

  /** @param {PadButton} button */
  #make({ text, label, hint, area, direction }) {
    const element = make("button", { type: "button", "aria-label": label }, make("b", {}, text));
    element.dataset["direction"] = direction.join();
    if (area) element.dataset["area"] = area;
    if (hint) element.append(make("kbd", {}, hint));
    this.#listen(element, direction);
    return element;
  }

  /**
   * @param {HTMLButtonElement} button
   * @param {number[]} direction
   */
  #listen(button, direction) {
    button.addEventListener("pointerdown", (event) => {
      if (this.#step !== null || event.button !== 0) return;
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      button.setPointerCapture(event.pointerId);
      this.#press(`pointer:${event.pointerId}`, direction);
    });
    for (const type of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
      button.addEventListener(type, (event) => this.#hands.release(`pointer:${event.pointerId}`));
    }
    button.addEventListener("click", () => {
      if (this.#step !== null) this.#press("click", direction);
    });
    button.addEventListener("keydown", (event) => {
      if (event.key !== " " && event.key !== "Enter") return;
      if (event.repeat || event.ctrlKey || event.altKey || event.metaKey) event.preventDefault();
      else if (this.#step === null) this.#press(`key:${event.code}`, direction);
    });
  }
}
