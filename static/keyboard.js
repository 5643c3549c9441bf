/**
 * The console's keys, heard in its own window and in the scene's frame.
 *
 * @typedef {{
 *   stop: () => void,
 *   shown: () => boolean,                      // whether the jog pad is on the screen
 *   jog: (event: KeyboardEvent) => boolean,    // begins a jog; false when the key is none
 *   release: (source: string) => void,
 *   releaseModifier: (modifier: string) => void,
 *   interrupt: () => void,
 * }} KeyHandlers
 */

import { isConsoleKey, isTextField, takesKeys } from "./keymap.js";

/** @param {{code: string}} event */
export function keySource({ code }) {
  return `key:${code}`;
}

/**
 * @param {Window} view
 * @param {KeyHandlers} handlers
 * @param {{inFrame: boolean, signal?: AbortSignal}} options
 */
export function listenToKeys(view, handlers, { inFrame, signal }) {
  const options = { capture: true, ...(signal && { signal }) };
  view.addEventListener("keydown", (event) => keyDown(event, handlers, inFrame), options);
  view.addEventListener("keyup", (event) => keyUp(event, handlers), options);
  view.addEventListener(
    "focusin",
    (event) => {
      if (isTextField(event.target)) handlers.interrupt();
    },
    options,
  );
}

/**
 * @param {KeyboardEvent} event
 * @param {KeyHandlers} handlers
 * @param {boolean} inFrame
 */
function keyDown(event, handlers, inFrame) {
  if (event.key === "Escape") {
    handlers.stop();
    return;
  }
  if (takesKeys(event.target)) return;
  if (event.ctrlKey || event.altKey || event.metaKey) {
    handlers.interrupt();
    return;
  }
  const shown = handlers.shown();
  if (!isConsoleKey(event.code) || !(shown || inFrame)) return;
  event.preventDefault();
  event.stopImmediatePropagation();
  if (shown && !event.repeat) handlers.jog(event);
}

/**
 * @param {KeyboardEvent} event
 * @param {KeyHandlers} handlers
 */
function keyUp(event, handlers) {
  handlers.release(keySource(event));
  handlers.releaseModifier(event.key);
}
