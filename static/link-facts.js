/**
 * Set-up: how the link is doing, in numbers.
 *
 * @import {Store} from "./store.js"
 * @import {RobotState} from "./types.js"
 */

import { byId, make, setText } from "./dom.js";

/** Numbers that change all the time are read more easily when they do so less often. */
const SHOWN_MS = 500;

/** @typedef {{name: string, title: string, whole?: true, value: (state: RobotState) => string}} Fact */

/** @type {readonly Fact[]} */
const FACTS = [
  { name: "Board", title: "What it calls itself, and its firmware", whole: true, value: ({ link }) => link.board ?? "\u2013" },
  { name: "Last news", title: "The age of its newest report", value: ({ link }) => ms(link.age_ms, 0) },
  { name: "Round trip", title: "From the newest command to its answer", value: ({ link }) => ms(link.round_trip_ms, 1) },
  { name: "Queue", title: "Motions that the board has, and room for them", value: ({ link }) => `${link.queued} / ${link.queue_places}` },
  { name: "Motion ahead", title: "How long that lasts", value: ({ link }) => ms(link.ahead_ms, 0) },
  { name: "Dropped", title: "Damaged frames that came from the board since it was connected", value: ({ link }) => String(link.dropped) },
  { name: "Underruns", title: "How often the board had to brake because this computer was late", value: ({ underruns }) => String(underruns) },
  { name: "Capture", title: "The file that all that passes is added to", whole: true, value: ({ capture }) => captured(capture) },
]; // prettier-ignore

/** @param {{store: Store}} parts */
export function addLinkFacts({ store }) {
  const list = byId("link-facts", HTMLElement);
  const rows = FACTS.map(({ name, title, whole, value }) => {
    const shown = make("dd");
    list.append(make("div", { title, ...(whole && { class: "whole" }) }, make("dt", {}, name), shown));
    return { value, shown };
  });
  let drawn = -Infinity;
  store.addView(() => {
    const { state } = store;
    const now = performance.now();
    list.hidden = state === null || ["closed", "opening"].includes(state.link.phase);
    if (state === null || now - drawn < SHOWN_MS) return;
    drawn = now;
    for (const { value, shown } of rows) setText(shown, value(state));
  });
}

/**
 * @param {number | null} value
 * @param {number} digits
 */
function ms(value, digits) {
  return value === null ? "\u2013" : `${value.toFixed(digits)} ms`;
}

/** @param {RobotState["capture"]} capture */
function captured(capture) {
  if (capture === null) return "off";
  const { name, size, lost, problem } = capture;
  const written = size < 1e6 ? `${Math.round(size / 1e3)} kB` : `${(size / 1e6).toFixed(1)} MB`;
  return problem ?? `${name}, ${written}${lost > 0 ? `, ${lost} records lost` : ""}`;
}
