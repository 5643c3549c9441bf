/**
 * Stop and E-stop: by the open socket and by HTTP at once, so that either suffices. Nothing
 * here waits, throttles or asks whether it is allowed.
 *
 * @import {Connection} from "./connection.js"
 * @import {Notices} from "./notices.js"
 * @import {Hands} from "./hands.js"
 * @import {Store} from "./store.js"
 */

/** @typedef {"stop" | "estop"} StopKind */

const TIMEOUT_MS = 3000;

export class Stopper {
  #connection;
  #hands;
  #notices;
  #store;

  /** @param {{connection: Connection, hands: Hands, notices: Notices, store: Store}} parts */
  constructor({ connection, hands, notices, store }) {
    this.#connection = connection;
    this.#hands = hands;
    this.#notices = notices;
    this.#store = store;
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
      return;
    }
    const lost = !sent || !this.#connection.open;
    // A socket may look open long after the network is gone.
    if (!lost && !this.#store.stale) return;
    const name = kind === "stop" ? "Stop" : "E-stop";
    const fate = lost ? "did not reach the server" : "was not answered";
    this.#notices.say("bad", `${name} ${fate}. Use the hardware emergency stop.`, Infinity);
  }
}
