/**
 * Mends viser's panel inside the frame.
 *
 * Its number boxes send half-typed and out-of-range numbers, so they are for reading only
 * (typed targets go into the console's fields). Its sliders and lines of text have no names.
 * And whoever only watches cannot use it.
 */

const BOX = "input.mantine-NumberInput-input";
const LINE = "input.mantine-TextInput-input";
const THUMB = ".mantine-Slider-thumb[role=slider]";
const PANELS = '[data-testid="floating-panel"], .mantine-Paper-root[style*="position: fixed"]';

export class ViserPanel {
  #inert = false;
  /** @type {Document | null} */
  #page = null;

  /**
   * @param {Window} view
   * @param {AbortSignal} signal
   */
  watch(view, signal) {
    const page = view.document;
    this.#page = page;
    const observer = new MutationObserver(() => this.#mend(page));
    observer.observe(page.documentElement, {
      subtree: true,
      childList: true,
      attributes: true,
      attributeFilter: ["aria-label", "readonly", "inert", "data-testid"],
    });
    signal.addEventListener("abort", () => observer.disconnect());
    view.addEventListener("keydown", keepFromBox, { capture: true, signal });
    this.#mend(page);
  }

  /** @param {boolean} inert */
  setInert(inert) {
    if (inert === this.#inert) return;
    this.#inert = inert;
    if (this.#page !== null) this.#mend(this.#page);
  }

  /** @param {Document} page */
  #mend(page) {
    for (const box of /** @type {NodeListOf<HTMLInputElement>} */ (page.querySelectorAll(BOX))) {
      if (!box.readOnly) box.readOnly = true;
      name(box, page, " value");
    }
    for (const input of page.querySelectorAll(`${LINE}, ${THUMB}`)) name(input, page, "");
    for (const panel of page.querySelectorAll(PANELS)) panel.toggleAttribute("inert", this.#inert);
  }
}

/**
 * Names an input after the row it stands in.
 *
 * @param {Element} element
 * @param {Document} page
 * @param {string} suffix
 */
function name(element, page, suffix) {
  if (element.getAttribute("aria-label")) return;
  const row = element.closest(".mantine-Flex-root:has(label)");
  const label = page.querySelector(`label[for="${CSS.escape(element.id)}"]`) ?? row?.querySelector("label");
  const text = label?.textContent?.trim();
  if (text) element.setAttribute("aria-label", text + suffix);
}

/**
 * A box that is only for reading still steps on arrow keys, which viser's library handles itself.
 *
 * @param {KeyboardEvent} event
 */
function keepFromBox(event) {
  const target = /** @type {Element | null} */ (event.target);
  if (!target?.matches?.(BOX) || event.key === "Tab" || event.ctrlKey || event.metaKey) return;
  event.stopPropagation();
}
