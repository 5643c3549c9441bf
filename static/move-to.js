/**
 * The fields for a typed target. They are sent by Enter or Go, filled on demand, and never
 * written while a person edits them.
 *
 * @import {Store} from "./store.js"
 * @import {Robot} from "./robot.js"
 */

import { post } from "./api.js";
import { byId, setText } from "./dom.js";
import { formatNumber, parseNumber } from "./numbers.js";
import { obstacleToMovingThere } from "./obstacle.js";
import { AXES, hasAxis } from "./robot.js";

const TOOL = AXES.length; // the place of the tool's field, behind the axes'
const NAMES = [...AXES, "Tool"];

/**
 * @param {(string | null)[]} texts of X, Y, Z and the tool's angle; null: the robot has no such
 * @returns {{values: number[]} | {problem: string, field: number}} an empty tool's field is NaN
 */
export function parseTarget(texts) {
  const values = [];
  for (const [field, text] of texts.entries()) {
    const empty = text === null || text.trim() === "";
    const optional = field === TOOL || text === null;
    const value = empty && optional ? (field === TOOL ? NaN : 0) : parseNumber(text ?? "");
    if (value === null) {
      const problem = empty ? `${NAMES[field]} is empty.` : `${NAMES[field]}: no number.`;
      return { problem, field };
    }
    values.push(value);
  }
  return { values };
}

/**
 * @param {Robot | null} robot
 * @param {number} field
 */
function isShown(robot, field) {
  return field === TOOL ? robot?.toolAxis === true : hasAxis(robot, field);
}

/** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
export function addMoveTo({ store, watch }) {
  const ids = ["move-x", "move-y", "move-z", "move-tool"];
  const fields = ids.map((id) => byId(id, HTMLInputElement));
  const problem = byId("move-problem", HTMLElement);
  const form = byId("move-form", HTMLFormElement);

  /**
   * @param {string} text
   * @param {number} [field]
   */
  const complain = (text, field) => {
    setText(problem, text);
    fields.forEach((input, i) => input.setAttribute("aria-invalid", String(i === field)));
  };
  for (const input of fields) input.addEventListener("input", () => complain(""));

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const texts = fields.map((input, i) => (isShown(store.robot, i) ? input.value : null));
    const target = parseTarget(texts);
    if ("problem" in target) {
      complain(target.problem, target.field);
      fields[target.field]?.focus();
      return;
    }
    complain("");
    const tool = target.values[TOOL] ?? NaN;
    const body = {
      xyz_mm: target.values.slice(0, TOOL),
      speed: 1,
      ...(Number.isFinite(tool) && { tool_deg: tool }),
    };
    const obstacle = obstacleToMovingThere(store);
    watch(obstacle ? Promise.reject(new Error(obstacle)) : post("move", body));
  });

  const fill = byId("move-fill", HTMLButtonElement);
  fill.addEventListener("click", () => {
    complain("");
    const { state } = store;
    fields.forEach((input, i) => {
      const value = i === TOOL ? state?.theta_deg?.at(-1) : state?.xyz_mm?.[i];
      input.value = formatNumber(value, 2);
    });
  });
  store.addView(() => {
    fill.disabled = store.stale || !store.state?.xyz_mm;
    fields.forEach((input, i) => input.parentElement?.toggleAttribute("hidden", !isShown(store.robot, i)));
    form.dataset["fields"] = String(fields.filter((_, i) => isShown(store.robot, i)).length);
  });
}
