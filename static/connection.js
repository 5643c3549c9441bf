/**
 * The page's websocket: reconnects with a growing pause, and never resumes anything.
 *
 * @import {Message, ServerMessage} from "./types.js"
 *
 * @typedef {{
 *   opened: (away: number) => void,  // after so many ms; 0 the first time
 *   closed: () => void,
 *   received: (message: ServerMessage) => void,
 * }} ConnectionHandlers
 */

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 4000;
const HANDSHAKE_MS = 5000;

export class Connection {
  /** @type {WebSocket | null} */
  #socket = null;
  #pause = FIRST_PAUSE_MS;
  /** @type {number | null} */
  #lostAt = null;
  #handlers;

  /** @param {ConnectionHandlers} handlers */
  constructor(handlers) {
    this.#handlers = handlers;
  }

  get open() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /**
   * @param {Message} message
   * @returns {boolean} whether it left the page
   */
  send(message) {
    if (!this.open) return false;
    this.#socket?.send(JSON.stringify(message));
    return true;
  }

  connect() {
    const url = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`;
    const socket = new WebSocket(url);
    this.#socket = socket;
    const handshake = setTimeout(() => socket.close(), HANDSHAKE_MS);
    socket.addEventListener("open", () => {
      clearTimeout(handshake);
      this.#pause = FIRST_PAUSE_MS;
      const away = this.#lostAt === null ? 0 : performance.now() - this.#lostAt;
      this.#lostAt = null;
      this.#handlers.opened(away);
    });
    socket.addEventListener("message", ({ data }) => this.#handlers.received(JSON.parse(data)));
    socket.addEventListener("close", () => {
      clearTimeout(handshake);
      this.#lost();
    });
  }

  #lost() {
    this.#lostAt ??= performance.now();
    this.#handlers.closed();
    setTimeout(() => void this.#reconnect(), this.#pause * (0.75 + Math.random() / 2));
    this.#pause = Math.min(this.#pause * 2, LONGEST_PAUSE_MS);
  }

  async #reconnect() {
    // A restarted server does not know this page's session: its start page gives a new one.
    await fetch("/", { cache: "no-store", signal: AbortSignal.timeout(HANDSHAKE_MS) }).catch(() => {});
    this.connect();
  }
}
