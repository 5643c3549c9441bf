/**
 * Set-up: which link there is, connecting to it, and what is wrong with it.
 *
 * @import {Store} from "./store.js"
 * @import {Link} from "./types.js"
 */

import { get, post } from "./api.js";
import { byId, leave, make, setText } from "./dom.js";

/** How often the list is read again while it shows: ports come and go. */
const LOOK_MS = 2000;

/** @type {Readonly<Record<Link["phase"], string>>} */
const ACTIONS = { closed: "Connect", opening: "Cancel", greeting: "Cancel", ready: "Disconnect" };

export class LinkChoice {
  #select = byId("links", HTMLSelectElement);
  #button = byId("connect", HTMLButtonElement);
  #problem = byId("link-problem", HTMLElement);
  #store;
  #listed = "";

  /** @param {{store: Store, watch: (action: Promise<unknown>) => void}} parts */
  constructor({ store, watch }) {
    this.#store = store;
    this.#button.addEventListener("click", () => {
      watch(this.#isClosed ? post("connect", { link: this.#select.value }) : post("disconnect"));
    });
    this.#select.addEventListener("change", () => leave(this.#select));
    store.addView(() => this.#draw());
    setInterval(() => {
      if (this.#isClosed && this.#select.checkVisibility({ visibilityProperty: true })) {
        this.refresh().catch(() => {}); // what is wrong with the server is told elsewhere
      }
    }, LOOK_MS);
  }

  get #isClosed() {
    return (this.#store.state?.link.phase ?? "closed") === "closed";
  }

  /** Asks which links there are. */
  async refresh() {
    /** @type {{id: string, description: string}[]} */
    const links = await get("ports");
    const listed = JSON.stringify(links);
    if (listed === this.#listed) return;
    this.#listed = listed;
    const chosen = this.#select.value;
    this.#select.replaceChildren(
      ...links.map(({ id, description }) => make("option", { value: id }, description)),
    );
    const wanted = [chosen, this.#store.state?.link.id].find((id) => links.some((l) => l.id === id));
    if (wanted !== undefined) this.#select.value = wanted;
    this.#store.changed();
  }

  #draw() {
    const { state, stale } = this.#store;
    const phase = state?.link.phase ?? "closed";
    const barred = stale || state?.control.holder === "another";
    setText(this.#button, ACTIONS[phase]);
    this.#button.disabled = barred || (phase === "closed" && !this.#select.value);
    this.#select.disabled = barred || phase !== "closed";
    if (state && phase !== "closed") this.#select.value = state.link.id;
    setText(this.#problem, state?.link.problem ?? "");
    this.#problem.hidden = !state?.link.problem;
  }
}
