/**
 * The numbers: reported, commanded, and speed as a share of the limit.
 *
 * @import {Store} from "./store.js"
 */

import { byId, make, setText } from "./dom.js";
import { formatNumber, formatShare } from "./numbers.js";
import { AXES, hasAxis, jointName } from "./robot.js";

/** @typedef {{reported: HTMLElement, commanded: HTMLElement, speed: HTMLElement}} Row */

export class Readouts {
  #body = byId("readouts", HTMLTableSectionElement);
  #strip = byId("strip", HTMLElement);
  #store;
  /** @type {Row[]} */
  #axes = AXES.map((axis) => this.#addRow(`${axis} mm`, "axis"));
  /** @type {Row[]} */
  #joints = [];
  #jointNames = "";
  #stripNumbers = AXES.map((axis) => {
    const number = make("b", {}, "–");
    this.#strip.append(make("div", {}, make("small", {}, `${axis} mm`), number));
    return number;
  });

  /** @param {Store} store */
  constructor(store) {
    this.#store = store;
    store.addView(() => this.#draw());
  }

  #draw() {
    const { state } = this.#store;
    document.documentElement.toggleAttribute("data-stale", this.#store.stale);
    if (state === null) return;
    this.#match(state.theta_deg?.length ?? this.#store.robot?.joints ?? this.#joints.length);
    this.#axes.forEach((row, i) =>
      fill(row, state.xyz_mm?.[i], state.command_xyz_mm?.[i], state.xyz_speed_share?.[i]),
    );
    this.#joints.forEach((row, i) =>
      fill(row, state.theta_deg?.[i], state.command_theta_deg?.[i], state.theta_speed_share?.[i]),
    );
    this.#stripNumbers.forEach((b, i) => setText(b, formatNumber(state.xyz_mm?.[i], 2)));
  }

  /**
   * Shows the rows of the robot's axes and joints.
   *
   * @param {number} joints
   */
  #match(joints) {
    const { robot } = this.#store;
    const shown = AXES.map((_, axis) => hasAxis(robot, axis));
    this.#axes.forEach((row, i) => row.reported.parentElement?.toggleAttribute("hidden", !shown[i]));
    this.#stripNumbers.forEach((b, i) => b.parentElement?.toggleAttribute("hidden", !shown[i]));
    const names = Array.from({ length: joints }, (_, i) => `${jointName(robot, i)} °`);
    if (names.join() === this.#jointNames) return;
    this.#jointNames = names.join();
    for (const row of this.#body.querySelectorAll(".joint")) row.remove();
    this.#joints = names.map((name) => this.#addRow(name, "joint"));
  }

  /**
   * @param {string} name
   * @param {string} kind
   * @returns {Row}
   */
  #addRow(name, kind) {
    const [reported, commanded, speed] = [make("td", {}, "–"), make("td", {}, "–"), make("td", {}, "–")];
    const head = make("th", { scope: "row" }, name);
    this.#body.append(make("tr", { class: kind }, head, reported, commanded, speed));
    return { reported, commanded, speed };
  }
}

/**
 * @param {Row} row
 * @param {number | undefined} reported
 * @param {number | undefined} commanded
 * @param {number | undefined} speed
 */
function fill(row, reported, commanded, speed) {
  setText(row.reported, formatNumber(reported, 2));
  setText(row.commanded, formatNumber(commanded, 2));
  setText(row.speed, formatShare(speed));
}
