/**
 * Sliders for the angles and the position, where viser's own panel has no room. A slider shows
 * the command, except while it is held; letting go moves the robot there, unless there was a
 * stop since it was taken hold of.
 *
 * @import {Store} from "./store.js"
 * @import {Robot, Range} from "./robot.js"
 */

import { post } from "./api.js";
import { byId, make, setText } from "./dom.js";
import { formatNumber } from "./numbers.js";
import { obstacleToMovingThere } from "./obstacle.js";
import { AXES, jointName } from "./robot.js";
import { Echo } from "./slider.js";

/** Arrow keys change a slider many times; one move follows when they pause. */
const KEYS_MS = 150;

/** @typedef {{input: HTMLInputElement, output: HTMLElement, held: boolean, void: boolean, echo: Echo}} Slider */

export class Pose {
  #box = byId("sliders", HTMLElement);
  #store;
  #watch;
  /** @type {Robot | null} */
  #built = null;
  /** @type {{field: "theta_deg" | "xyz_mm", sliders: (Slider | null)[]}[]} */
  #groups = [];
  /** @type {number | undefined} */
  #waiting;
  /** @type {string | null} */
  #stopReason = null;

  /** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
  constructor({ store, watch }) {
    this.#store = store;
    this.#watch = watch;
    store.addView(() => this.#draw());
  }

  /** What is held or about to be sent moves nothing any more; that takes a fresh press. */
  letGo() {
    clearTimeout(this.#waiting);
    for (const slider of this.#groups.flatMap(({ sliders }) => sliders)) {
      if (slider?.held) Object.assign(slider, { held: false, void: true });
    }
  }

  #draw() {
    const { state, robot } = this.#store;
    if (robot !== this.#built) this.#build(robot);
    const moving = state?.mode === "moving" || state?.mode === "jogging";
    const barred = !moving && obstacleToMovingThere(this.#store) !== null;
    const stopReason = state?.stop_reason ?? null;
    const stopped = stopReason !== null && stopReason !== this.#stopReason;
    this.#stopReason = stopReason;
    if (barred || stopped) this.letGo();
    for (const { field, sliders } of this.#groups) {
      const command = state?.[`command_${field}`];
      const reported = state?.[field];
      sliders.forEach((slider, i) => {
        if (slider === null) return;
        slider.input.disabled = barred;
        const free = !slider.held && slider.echo.over;
        const value = command?.[i];
        if (free && value !== undefined) slider.input.value = String(value);
        const shown = slider.held ? Number(slider.input.value) : reported?.[i];
        setText(slider.output, formatNumber(shown, 1));
      });
    }
  }

  /** @param {Robot | null} robot */
  #build(robot) {
    this.#built = robot;
    this.#box.replaceChildren();
    this.#groups = [];
    if (robot === null) return;
    this.#addGroup("theta_deg", robot.angles.map((range, i) => ({ name: `${jointName(robot, i)} °`, range })));
    this.#addGroup("xyz_mm", robot.axes.map((range, i) => ({ name: `${AXES[i]} mm`, range })));
  }

  /**
   * @param {"theta_deg" | "xyz_mm"} field
   * @param {{name: string, range: Range | null}[]} rows one for each number of the field; those
   *   without a range are 0 and get no slider
   */
  #addGroup(field, rows) {
    /** @type {(Slider | null)[]} */
    const sliders = rows.map(({ name, range }) => {
      if (range === null) return null;
      const [min, max] = range;
      const input = make("input", {
        type: "range", min: String(min), max: String(max), step: "0.1", "aria-label": name,
      });
      const output = make("span", { class: "numbers" }, "–");
      this.#box.append(make("label", { class: "row" }, make("span", { class: "label" }, name), input, output));
      return { input, output, held: false, void: false, echo: new Echo() };
    });
    this.#groups.push({ field, sliders });
    sliders.forEach((slider, i) => slider && this.#listen(slider, i, field, sliders));
  }

  /**
   * @param {Slider} slider
   * @param {number} index
   * @param {"theta_deg" | "xyz_mm"} field
   * @param {(Slider | null)[]} sliders
   */
  #listen(slider, index, field, sliders) {
    slider.input.addEventListener("pointerdown", () => (slider.void = false));
    slider.input.addEventListener("keydown", ({ key }) => {
      if (key !== "Escape") slider.void = false;
    });
    slider.input.addEventListener("input", () => {
      slider.held = !slider.void;
      this.#store.changed();
    });
    slider.input.addEventListener("change", () => {
      if (slider.void) return;
      slider.held = false;
      slider.echo.touch();
      clearTimeout(this.#waiting);
      this.#waiting = setTimeout(() => this.#go(field, index, sliders), KEYS_MS);
    });
  }

  /**
   * @param {"theta_deg" | "xyz_mm"} field
   * @param {number} index of the slider that was let go
   * @param {(Slider | null)[]} sliders
   */
  #go(field, index, sliders) {
    const command = this.#store.state?.[`command_${field}`];
    const target = sliders.map((slider, i) => {
      const shown = Number(slider?.input.value ?? 0);
      return i === index ? shown : (command?.[i] ?? shown);
    });
    this.#watch(post("move", { [field]: target, speed: 1 }));
  }
}
