/**
 * Things that happened and are said for a while: a refusal, a lost connection.
 *
 * @typedef {"bad" | "warn" | "quiet"} Tone
 * @typedef {{tone: Tone, text: string, until: number}} Notice
 */

const SHOWN_MS = 8000;

export class Notices {
  /** @type {Notice | null} */
  #notice = null;
  #changed;

  /** @param {() => void} changed */
  constructor(changed) {
    this.#changed = changed;
  }

  /** @returns {Notice | null} */
  get current() {
    return this.#notice !== null && performance.now() < this.#notice.until ? this.#notice : null;
  }

  /**
   * @param {Tone} tone
   * @param {string} text
   * @param {number} [ms] how long; Infinity until the next action
   */
  say(tone, text, ms = SHOWN_MS) {
    this.#notice = { tone, text, until: performance.now() + ms };
    this.#changed();
  }

  /** The person went on: what was said is old. */
  clear() {
    this.#notice = null;
    this.#changed();
  }

  /**
   * Says why an action was refused.
   *
   * @param {Promise<unknown>} action
   */
  async watch(action) {
    try {
      await action;
      this.clear();
    } catch (error) {
      this.say("warn", error instanceof Error ? error.message : String(error));
    }
  }
}
