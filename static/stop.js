/**
 * Stop and E-stop: by the open socket and by HTTP at once, so that either suffices. Nothing
 * here waits, throttles or asks whether it is allowed.
 *
 * @import {Connection} from "./connection.js"
 * @import {Notices} from "./notices.js"
 * @import {Hands} from "./hands.js"
 */

/** @typedef {"stop" | "estop"} StopKind */

const TIMEOUT_MS = 3000;

export class Stopper {
  #connection;
  #hands;
  #notices;

  /** @param {{connection: Connection, hands: Hands, notices: Notices}} parts */
  constructor({ connection, hands, notices }) {
    this.#connection = connection;
    this.#hands = hands;
    this.#notices = notices;
  }

  /** @param {StopKind} kind */
  stop(kind) {
    const sent = this.#connection.send({ type: kind });
    const posted = fetch(`/api/${kind}`, {
      method: "POST",
      keepalive: true,
      signal: AbortSignal.timeout(TIMEOUT_MS),
    });
    this.#hands.letGo();
    void this.#confirm(kind, sent, posted);
  }

  /**
   * @param {StopKind} kind
   * @param {boolean} sent
   * @param {Promise<Response>} posted
   */
  async #confirm(kind, sent, posted) {
    const arrived = await posted.then((response) => response.ok, () => false);
    if (arrived) {
      this.#notices.clear();
    } else if (!sent || !this.#connection.open) {
      const name = kind === "stop" ? "Stop" : "E-stop";
      this.#notices.say("bad", `${name} did not reach the server. Use the hardware emergency stop.`, Infinity);
    }
  }
}
