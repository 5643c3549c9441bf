/**
 * The view of the scene: the equals of what viser's panel holds beside angles and position, for
 * screens where that has no room, for keyboards and for screen readers. Nothing here moves the
 * robot.
 *
 * @import {Item, ViewRow} from "./types.js"
 */

import { byId, make, setText } from "./dom.js";
import { Echo, paced } from "./slider.js";

/** @typedef {{element: HTMLElement, update: (item: any) => void}} Drawn */

export class SceneView {
  #box = byId("view-items", HTMLElement);
  #choose;
  /** The shape of what is drawn: while it stays, only values change. */
  #shape = "";
  /** @type {Map<string, Drawn>} */
  #drawn = new Map();

  /** @param {{choose: (key: string, value: boolean | number | string) => void}} parts */
  constructor({ choose }) {
    this.#choose = choose;
    this.show(null);
  }

  /** @param {Item[] | null} items null: there is no scene */
  show(items) {
    const shape = JSON.stringify(items?.map(({ kind, key }) => [kind, key]) ?? null);
    if (shape !== this.#shape) this.#build(items);
    this.#shape = shape;
    for (const item of items ?? []) this.#drawn.get(item.key)?.update(item);
  }

  /** @param {Item[] | null} items */
  #build(items) {
    if (items === null) {
      this.#drawn.clear();
      this.#box.replaceChildren(make("p", { class: "note" }, "The scene is not open yet."));
      return;
    }
    const focused = document.activeElement;
    /** @type {Map<string, Drawn>} */
    const drawn = new Map();
    /** @type {Map<string, HTMLElement>} */
    const groups = new Map();
    for (const item of items) {
      const kept = this.#drawn.get(item.key) ?? this.#draw(item);
      drawn.set(item.key, kept);
      const group = groups.get(item.group) ?? newGroup(item.group);
      groups.set(item.group, group);
      group.append(kept.element);
    }
    this.#drawn = drawn;
    this.#box.replaceChildren(...groups.values());
    // What stays was taken out and put in again, which takes the focus from it.
    if (focused instanceof HTMLElement && this.#box.contains(focused)) focused.focus({ preventScroll: true });
  }

  /**
   * @param {Item} item
   * @returns {Drawn}
   */
  #draw(item) {
    /** @param {boolean | number | string} value */
    const choose = (value) => this.#choose(item.key, value);
    switch (item.kind) {
      case "toggle":
        return drawToggle(item, choose);
      case "choice":
        return drawChoice(item, choose);
      case "slider":
        return drawSlider(item, choose);
      case "line":
        return drawLine(item, choose);
      case "button":
        return drawButton(item, choose);
      case "readout":
        return drawReadout();
    }
  }
}

/** @param {string} name */
function newGroup(name) {
  return make("fieldset", {}, make("legend", {}, name));
}

/**
 * @param {Extract<Item, {kind: "toggle"}>} item
 * @param {(value: boolean) => void} choose
 * @returns {Drawn}
 */
function drawToggle(item, choose) {
  const input = make("input", { type: "checkbox" });
  input.addEventListener("change", () => choose(input.checked));
  return {
    element: make("label", { class: "row check" }, input, item.label),
    update: ({ value }) => {
      input.checked = value;
    },
  };
}

/**
 * @param {Extract<Item, {kind: "choice"}>} item
 * @param {(value: string) => void} choose
 * @returns {Drawn}
 */
function drawChoice(item, choose) {
  const select = make("select");
  let offered = "";
  select.addEventListener("change", () => choose(select.value));
  return {
    element: make("label", { class: "row" }, make("span", { class: "label" }, item.label), select),
    update: ({ value, options }) => {
      if (offered !== (offered = options.join("\n"))) {
        select.replaceChildren(.../** @type {string[]} */ (options).map((name) => make("option", {}, name)));
      }
      select.value = value;
    },
  };
}

/**
 * @param {Extract<Item, {kind: "slider"}>} item
 * @param {(value: number) => void} choose
 * @returns {Drawn}
 */
function drawSlider(item, choose) {
  const input = make("input", { type: "range" });
  const output = make("span", { class: "numbers" });
  const echo = new Echo();
  const send = paced(() => choose(Number(input.value)));
  input.addEventListener("input", () => {
    echo.touch();
    setText(output, input.value);
    send();
  });
  return {
    element: make("label", { class: "row" }, make("span", { class: "label" }, item.label), input, output),
    update: ({ value, low, high, step }) =>
      echo.whenOver(() => {
        Object.assign(input, { min: String(low), max: String(high), step: String(step) });
        input.value = String(value);
        setText(output, input.value);
      }),
  };
}

/**
 * @param {Extract<Item, {kind: "line"}>} item
 * @param {(value: string) => void} choose
 * @returns {Drawn}
 */
function drawLine(item, choose) {
  const input = make("input", { type: "text", maxlength: String(item.longest), title: item.hint });
  input.addEventListener("change", () => choose(input.value));
  return {
    element: make("label", { class: "row" }, make("span", { class: "label" }, item.label), input),
    update: ({ value }) => {
      if (document.activeElement !== input) input.value = value;
    },
  };
}

/**
 * @param {Extract<Item, {kind: "button"}>} item
 * @param {(value: boolean) => void} choose
 * @returns {Drawn}
 */
function drawButton(item, choose) {
  const button = make("button", { type: "button" }, item.label);
  button.addEventListener("click", () => choose(true));
  return {
    element: button,
    update: ({ disabled }) => {
      button.disabled = disabled;
    },
  };
}

/** @returns {Drawn} */
function drawReadout() {
  const element = make("div", { class: "told numbers", "aria-live": "polite" });
  let shown = "";
  return {
    element,
    update: ({ rows }) => {
      const text = JSON.stringify(rows);
      if (text !== shown) element.replaceChildren(...rows.map(drawRow));
      shown = text;
    },
  };
}

/** @param {ViewRow} row */
function drawRow(row) {
  if (row.kind === "colours") {
    const bar = make("i", { class: "colours", "aria-hidden": "true" });
    bar.style.background = `linear-gradient(90deg, ${row.stops.map(css).join(", ")})`;
    return make("div", {}, row.name, bar, make("div", { class: "pair" }, make("span", {}, row.low), make("span", {}, row.high)));
  }
  const text = make("span", {}, row.text);
  if (row.dot !== null) {
    const dot = make("i", { class: "dot", "aria-hidden": "true" });
    dot.style.background = css(row.dot);
    text.prepend(dot);
  }
  return make("div", { class: "pair" }, text, ...(row.value ? [make("span", {}, row.value)] : []));
}

/** @param {[number, number, number]} colour */
function css([red, green, blue]) {
  return `rgb(${red} ${green} ${blue})`;
}
