/** Small helpers for the page's own elements. */

/**
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} type
 * @returns {T}
 */
export function byId(id, type) {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`the page has no ${type.name} #${id}`);
  return element;
}

/**
 * Sets a text only when it changes, so that nothing is announced or laid out again.
 *
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {{[attribute: string]: string}} [attributes]
 * @param {(Node | string)[]} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/**
 * Runs on the press itself, not on the release: a stop waits for no finger to lift. The click
 * is for keyboards and assistive technology, which send no pointer events.
 *
 * @param {HTMLElement} button
 * @param {() => void} action
 */
export function onPress(button, action) {
  let pressed = false;
  button.addEventListener("pointerdown", () => {
    pressed = true;
    action();
  });
  button.addEventListener("click", (event) => {
    // A press that was let go elsewhere is followed by no click: the next may be a key's.
    if (!pressed || event.detail === 0) action();
    pressed = false;
  });
}

/**
 * Marks one of a group of toggle buttons as the chosen one.
 *
 * @param {Iterable<Element>} buttons
 * @param {(button: HTMLElement) => boolean} chosen
 */
export function markPressed(buttons, chosen) {
  for (const button of buttons) {
    const pressed = String(chosen(/** @type {HTMLElement} */ (button)));
    if (button.getAttribute("aria-pressed") !== pressed) button.setAttribute("aria-pressed", pressed);
  }
}

/**
 * After a choice by pointer the arrow keys are for jogging again; who chose by keyboard stays.
 *
 * @param {HTMLSelectElement} select
 */
export function leave(select) {
  if (!select.matches(":focus-visible")) select.blur();
}
