/**
 * The dead-man's switch of a drag in the scene: signs of life while the pointer that went down
 * in the frame is still down, and none after anything broke the hold. Time is passed in.
 *
 * Letting go is no loss, but its news goes another way: by the scene's own page, which may be
 * drawing for a while first. Until it can have arrived the signs of life go on.
 *
 * @import {Message} from "./types.js"
 */

/** How much later than the pointer's release the scene may report it. */
export const LINGER_MS = 1000;

export class Drag {
  /** @type {number | null} */
  #pointer = null;
  #lingersUntil = -Infinity;
  #seq = 0;

  get held() {
    return this.#pointer !== null;
  }

  /** @param {number} pointer id of the pointer; ignored while another is down */
  press(pointer) {
    this.#pointer ??= pointer;
  }

  /**
   * @param {number} pointer
   * @param {number} now ms
   */
  release(pointer, now) {
    if (this.#pointer !== pointer) return;
    this.#pointer = null;
    this.#lingersUntil = now + LINGER_MS;
  }

  interrupt() {
    this.#pointer = null;
    this.#lingersUntil = -Infinity;
  }

  /** @param {number} now ms */
  beats(now) {
    return this.held || now < this.#lingersUntil;
  }

  /**
   * @param {number} now ms
   * @returns {Message[]}
   */
  beat(now) {
    if (!this.beats(now)) return [];
    this.#seq += 1;
    return [{ type: "drag_alive", seq: this.#seq, t_ms: now }];
  }
}
