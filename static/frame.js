/**
 * The scene's frame. It is of the same origin, so the console hears what happens in it; each
 * load brings a new window, to be watched anew.
 *
 * @typedef {(view: Window, signal: AbortSignal) => void} Watcher
 */

import { sceneAddress } from "./scene-address.js";

export class SceneFrame {
  #element;
  #watchers;
  #loaded = new AbortController();
  #reloaded;
  #loading = false;

  /**
   * @param {HTMLIFrameElement} element
   * @param {{watchers: Watcher[], reloaded: () => void}} options
   *   `watchers` are attached to the window of each load until the next
   */
  constructor(element, { watchers, reloaded }) {
    this.#element = element;
    this.#watchers = watchers;
    this.#reloaded = reloaded;
    element.addEventListener("load", () => this.#attach());
    this.#load();
  }

  /** @returns {Document | null} null while an error page stands in the frame */
  get document() {
    try {
      const page = this.#element.contentDocument;
      return page !== null && page.location.pathname.startsWith("/scene/") ? page : null;
    } catch {
      return null;
    }
  }

  /** Loads the scene again if an error page stands in its place. */
  mend() {
    if (this.document === null && !this.#loading) this.#load();
  }

  #load() {
    this.#loading = true;
    this.#element.src = sceneAddress();
  }

  #attach() {
    this.#loading = false;
    this.#loaded.abort();
    this.#loaded = new AbortController();
    this.#reloaded();
    const view = this.document?.defaultView;
    if (!view) return;
    for (const watch of this.#watchers) watch(view, this.#loaded.signal);
  }
}
