/**
 * The newest picture of the machine and of the connection to it. Views read it and are told of
 * changes at most once a frame; nothing in the page keeps a robot's state of its own.
 *
 * @import {RobotState} from "./types.js"
 * @import {Robot} from "./robot.js"
 */

/** Numbers older than this are shown as old. */
export const STALE_MS = 1000;

export class Store {
  /** @type {RobotState | null} */
  state = null;
  /** @type {Robot | null} */
  robot = null;
  connected = false;
  #arrived = -Infinity;
  #scheduled = false;
  /** @type {(() => void)[]} */
  #views = [];
  /** @type {((state: RobotState) => void)[]} */
  #listeners = [];

  /** Whether the numbers on the page may no longer be true. */
  get stale() {
    return !this.connected || performance.now() - this.#arrived > STALE_MS;
  }

  /** Age of the newest state (ms). */
  get age() {
    return performance.now() - this.#arrived;
  }

  /** @param {RobotState} state */
  receive(state) {
    this.state = state;
    this.#arrived = performance.now();
    for (const listener of this.#listeners) listener(state);
    this.changed();
  }

  /** Draws the views with the next frame. */
  changed() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => {
      this.#scheduled = false;
      for (const view of this.#views) view();
    });
  }

  /** @param {() => void} view drawn after changes */
  addView(view) {
    this.#views.push(view);
  }

  /** @param {(state: RobotState) => void} listener told of every state at once */
  onState(listener) {
    this.#listeners.push(listener);
  }
}
