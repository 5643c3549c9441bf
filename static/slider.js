/** A slider that speaks while it moves, and is not written over by what the server said before. */

/** Between two messages while it moves; the last value always goes. */
const PAUSE_MS = 50;

/** How long the server may take to tell back what was chosen. */
const ECHO_MS = 600;

export class Echo {
  #touched = -Infinity;
  /** @type {number | undefined} */
  #waiting;

  /** A person has chosen a value. */
  touch() {
    this.#touched = performance.now();
  }

  /** Whether what the server tells is news again. */
  get over() {
    return performance.now() - this.#touched > ECHO_MS;
  }

  /**
   * Shows what the server told as soon as it is news again: it may not be told a second time.
   *
   * @param {() => void} show only the last one given is called
   */
  whenOver(show) {
    clearTimeout(this.#waiting);
    if (this.over) show();
    else this.#waiting = setTimeout(() => this.whenOver(show), ECHO_MS);
  }
}

/**
 * @param {() => void} send
 * @returns {() => void} sends soon, once for all calls until then
 */
export function paced(send) {
  /** @type {number | undefined} */
  let waiting;
  return () => {
    waiting ??= setTimeout(() => {
      waiting = undefined;
      send();
    }, PAUSE_MS);
  };
}
