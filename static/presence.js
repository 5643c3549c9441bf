/**
 * Whether a person is at this page: it is visible, and it or its frame has the focus.
 *
 * A click into the frame blurs the console's window while the top document keeps the focus;
 * that is no loss. When the frame had the focus, the console's window hears no blur at all, so
 * the frame's window is watched, too.
 */

export function isPresent() {
  return document.visibilityState === "visible" && document.hasFocus();
}

/**
 * @param {Window} view the console's or the frame's window
 * @param {() => void} lost
 * @param {AbortSignal} [signal] ends the watch
 */
export function watchPresence(view, lost, signal) {
  const options = { capture: true, ...(signal && { signal }) };
  const check = () => {
    if (!isPresent()) lost();
  };
  view.addEventListener("blur", check, options);
  view.addEventListener("pagehide", lost, options);
  view.document.addEventListener("visibilitychange", check, options);
  view.document.addEventListener("freeze", lost, options);
}
