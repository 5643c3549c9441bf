/**
 * A held jog as a state machine: events in, messages out, time passed in.
 *
 * Only what began a jog (its source: one key or one pointer) ends it by release; anything may
 * interrupt it. After either a fresh press is needed, under a fresh id.
 *
 * @import {Frame, Message, Mode, RobotState} from "./types.js"
 *
 * @typedef {{
 *   frame: Frame,
 *   velocity: number[],  // mm/s, or degrees/s in the frame of the joints
 *   modifier?: string,   // the modifier key that belongs to this press
 * }} JogRequest
 *
 * @typedef {JogRequest & {id: string, source: string, seq: number, began: number,
 *   beaten: number, stopReason: string | null}} HeldJog
 */

/** A page that slept longer than this between two heartbeats has lost its lease at the server. */
export const LEASE_MS = 200;

/** How long the server may take to report that it is jogging. */
export const ANSWER_MS = 1000;

/** @type {ReadonlySet<Mode>} */
const MODES_THAT_JOG = new Set(["idle", "unhomed", "jogging"]);

export class Jog {
  /** @type {HeldJog | null} */
  #held = null;
  #newId;

  /** @param {{newId: () => string}} options */
  constructor({ newId }) {
    this.#newId = newId;
  }

  get held() {
    return this.#held;
  }

  /**
   * A press. Ignored while another is held.
   *
   * @param {string} source
   * @param {JogRequest} request
   * @param {RobotState} state
   * @param {number} now ms
   * @returns {Message[]}
   */
  begin(source, request, state, now) {
    if (this.#held !== null) return [];
    const id = this.#newId();
    this.#held = {
      ...request, id, source, seq: 0, began: now, beaten: now, stopReason: state.stop_reason,
    };
    return [{ type: "jog_start", id, frame: request.frame, ...velocityField(request) }];
  }

  /**
   * The sign of life. After a pause that outlived the lease there is none, but an end.
   *
   * @param {number} now ms
   * @returns {Message[]}
   */
  beat(now) {
    const held = this.#held;
    if (held === null) return [];
    if (now - held.beaten > LEASE_MS) return this.interrupt();
    held.seq += 1;
    held.beaten = now;
    return [{ type: "jog", id: held.id, seq: held.seq, t_ms: now, ...velocityField(held) }];
  }

  /**
   * A release.
   *
   * @param {string} source
   * @returns {Message[]}
   */
  release(source) {
    return this.#held?.source === source ? this.interrupt() : [];
  }

  /**
   * The release of a modifier key ends the jog that was pressed with it.
   *
   * @param {string} modifier
   * @returns {Message[]}
   */
  releaseModifier(modifier) {
    return this.#held?.modifier === modifier ? this.interrupt() : [];
  }

  /** @returns {Message[]} */
  interrupt() {
    if (this.#held === null) return [];
    const { id } = this.#held;
    this.#held = null;
    return [{ type: "jog_end", id }];
  }

  /**
   * The server refused the jog with this id: there is nothing left to hold.
   *
   * @param {string | null} id
   * @returns {Message[]}
   */
  refuse(id) {
    return this.#held?.id === id ? this.interrupt() : [];
  }

  /**
   * Ends the jog when the machine tells that it no longer jogs, or that another is in control.
   *
   * @param {RobotState} state
   * @param {number} now ms
   * @returns {Message[]}
   */
  observe(state, now) {
    const held = this.#held;
    if (held === null) return [];
    const stopped = state.stop_reason !== null && state.stop_reason !== held.stopReason;
    const unanswered = state.mode !== "jogging" && now - held.began > ANSWER_MS;
    const ended =
      !MODES_THAT_JOG.has(state.mode) || stopped || unanswered || state.control.holder === "another";
    held.stopReason = state.stop_reason;
    return ended ? this.interrupt() : [];
  }
}

/** @param {JogRequest} request */
function velocityField({ frame, velocity }) {
  return frame === "joints" ? { v_deg_s: velocity } : { v_mm_s: velocity };
}
