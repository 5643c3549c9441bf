/**
 * The dead-man's switch of a drag in the scene: signs of life while the pointer that went down
 * in the frame is still down, and none after anything broke the hold. Time is passed in.
 *
 * @import {Message} from "./types.js"
 */

export class Drag {
  /** @type {number | null} */
  #pointer = null;
  #seq = 0;

  get held() {
    return this.#pointer !== null;
  }

  /** @param {number} pointer id of the pointer; ignored while another is down */
  press(pointer) {
    this.#pointer ??= pointer;
  }

  /** @param {number} pointer */
  release(pointer) {
    if (this.#pointer === pointer) this.#pointer = null;
  }

  interrupt() {
    this.#pointer = null;
  }

  /**
   * @param {number} now ms
   * @returns {Message[]}
   */
  beat(now) {
    if (this.#pointer === null) return [];
    this.#seq += 1;
    return [{ type: "drag_alive", seq: this.#seq, t_ms: now }];
  }
}
