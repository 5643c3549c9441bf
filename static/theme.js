/** Light, dark, or as the system has it; remembered for the next visit. */

/** @typedef {"auto" | "light" | "dark"} Theme */

const KEY = "deltaviz-theme";
/** @type {readonly Theme[]} */
const ORDER = ["auto", "light", "dark"];

export class ThemeChoice {
  #system = matchMedia("(prefers-color-scheme: dark)");
  #changed;

  /** @param {() => void} changed */
  constructor(changed) {
    this.#changed = changed;
    this.#system.addEventListener("change", changed);
  }

  /** @returns {Theme} */
  get theme() {
    const chosen = document.documentElement.dataset["theme"];
    return chosen === "light" || chosen === "dark" ? chosen : "auto";
  }

  get dark() {
    return this.theme === "auto" ? this.#system.matches : this.theme === "dark";
  }

  next() {
    const theme = ORDER[(ORDER.indexOf(this.theme) + 1) % ORDER.length] ?? "auto";
    if (theme === "auto") delete document.documentElement.dataset["theme"];
    else document.documentElement.dataset["theme"] = theme;
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // A browser may forbid storage; the choice then lasts as long as the page.
    }
    this.#changed();
  }
}
