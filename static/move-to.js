/**
 * The fields for a typed target. They are sent by Enter or Go, filled on demand, and never
 * written while a person edits them.
 *
 * @import {Store} from "./store.js"
 */

import { post } from "./api.js";
import { byId, setText } from "./dom.js";
import { formatNumber, parseNumber } from "./numbers.js";
import { obstacleToMovingThere } from "./obstacle.js";

const AXES = ["X", "Y", "Z"];

/**
 * @param {string[]} texts of X, Y, Z
 * @returns {{xyz: number[]} | {problem: string, axis: number}}
 */
export function parseTarget(texts) {
  const xyz = [];
  for (const [axis, text] of texts.entries()) {
    const value = parseNumber(text);
    if (value === null) {
      const typed = text.trim();
      const problem = typed ? `${AXES[axis]}: no number.` : `${AXES[axis]} is empty.`;
      return { problem, axis };
    }
    xyz.push(value);
  }
  return { xyz };
}

/** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
export function addMoveTo({ store, watch }) {
  const fields = ["move-x", "move-y", "move-z"].map((id) => byId(id, HTMLInputElement));
  const problem = byId("move-problem", HTMLElement);

  /**
   * @param {string} text
   * @param {number} [axis]
   */
  const complain = (text, axis) => {
    setText(problem, text);
    fields.forEach((field, i) => field.setAttribute("aria-invalid", String(i === axis)));
  };
  for (const field of fields) field.addEventListener("input", () => complain(""));

  byId("move-form", HTMLFormElement).addEventListener("submit", (event) => {
    event.preventDefault();
    const target = parseTarget(fields.map((field) => field.value));
    if ("problem" in target) {
      complain(target.problem, target.axis);
      fields[target.axis]?.focus();
      return;
    }
    complain("");
    const obstacle = obstacleToMovingThere(store);
    watch(obstacle ? Promise.reject(new Error(obstacle)) : post("move", { xyz_mm: target.xyz, speed: 1 }));
  });

  const fill = byId("move-fill", HTMLButtonElement);
  fill.addEventListener("click", () => {
    complain("");
    fields.forEach((field, i) => (field.value = formatNumber(store.state?.xyz_mm?.[i], 2)));
  });
  store.addView(() => (fill.disabled = store.stale || !store.state?.xyz_mm));
}
