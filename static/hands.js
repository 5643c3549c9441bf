/**
 * What a person holds: a jog on this page, or something dragged in the scene. Sends the signs
 * of life from the main thread, and lets go of everything when anything breaks the hold.
 *
 * @import {Connection} from "./connection.js"
 * @import {JogRequest} from "./jog.js"
 * @import {Store} from "./store.js"
 * @import {Message, RobotState} from "./types.js"
 */

import { Drag } from "./drag.js";
import { Jog } from "./jog.js";
import { isPresent } from "./presence.js";

/** Between two signs of life. */
const BEAT_MS = 60;

/** Nobody jogs blind: without news from the robot for this long a jog ends. */
const BLIND_MS = 500;

export class Hands {
  #jog = new Jog({ newId });
  #drag = new Drag();
  #connection;
  #store;
  /** @type {number | undefined} */
  #timer;

  /** @param {{connection: Connection, store: Store}} parts */
  constructor({ connection, store }) {
    this.#connection = connection;
    this.#store = store;
    store.onState((state) => this.#observe(state));
  }

  /** @returns {string | null} what began the jog that is held */
  get source() {
    return this.#jog.held?.source ?? null;
  }

  /** @returns {readonly number[] | null} its velocity */
  get velocity() {
    return this.#jog.held?.velocity ?? null;
  }

  /**
   * @param {string} source the key or pointer pressed
   * @param {JogRequest} request
   */
  press(source, request) {
    const { state } = this.#store;
    if (state === null || !isPresent()) return;
    this.#send(this.#jog.begin(source, request, state, performance.now()));
    this.#keepBeating();
  }

  /** @param {string} source */
  release(source) {
    this.#send(this.#jog.release(source));
  }

  /** @param {string} modifier */
  releaseModifier(modifier) {
    this.#send(this.#jog.releaseModifier(modifier));
  }

  /** @param {number} pointer that went down in the scene */
  grab(pointer) {
    if (this.#drag.held) return;
    this.#drag.press(pointer);
    this.#beat();
    this.#keepBeating();
  }

  /** @param {number} pointer */
  drop(pointer) {
    this.#drag.release(pointer, performance.now());
  }

  /** The pointer in the scene was taken away, not let go. */
  loseDrag() {
    this.#drag.interrupt();
  }

  /** Ends the jog, whatever holds it. */
  endJog() {
    this.#send(this.#jog.interrupt());
  }

  /** Ends everything that is held; it takes a fresh press to move again. */
  letGo() {
    this.endJog();
    this.#drag.interrupt();
  }

  /**
   * The server no longer lets the jog with this id live.
   *
   * @param {string | null} id
   * @returns {boolean} whether it was the one that is held
   */
  refused(id) {
    const ended = this.#jog.refuse(id);
    this.#send(ended);
    return ended.length > 0;
  }

  #keepBeating() {
    this.#timer ??= setInterval(() => this.#tick(), BEAT_MS);
  }

  #tick() {
    if (!isPresent() || !this.#connection.open) this.letGo();
    else if (this.#store.age > BLIND_MS) this.endJog();
    if (this.#jog.held === null && !this.#drag.beats(performance.now())) {
      clearInterval(this.#timer);
      this.#timer = undefined;
      return;
    }
    this.#beat();
  }

  #beat() {
    const now = performance.now();
    this.#send(this.#jog.beat(now));
    this.#send(this.#drag.beat(now));
  }

  /** @param {RobotState} state */
  #observe(state) {
    this.#send(this.#jog.observe(state, performance.now()));
  }

  /** @param {Message[]} messages */
  #send(messages) {
    for (const message of messages) this.#connection.send(message);
    if (messages.length > 0) this.#store.changed();
  }
}

/** Names one press. `crypto.randomUUID` is withheld on http from the network. */
function newId() {
  const bytes = crypto.getRandomValues(new Uint8Array(12));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}
