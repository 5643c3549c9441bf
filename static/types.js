/**
 * The shapes that travel between the server and this page. Lengths in mm, angles in degrees.
 *
 * @typedef {"offline" | "disabled" | "unhomed" | "homing" | "idle" | "jogging" | "moving"
 *   | "running" | "paused" | "stopping" | "fault" | "estop"} Mode
 *
 * `problem` says what happened to the link and what to do, `note` what became of a board that was
 * met again.
 * @typedef {{
 *   id: string,
 *   connected: boolean,
 *   phase: "closed" | "opening" | "greeting" | "ready",
 *   age_ms: number | null,
 *   problem: string | null,
 *   note: string | null,
 *   board: string | null,
 *   round_trip_ms: number | null,
 *   dropped: number,
 *   queued: number,
 *   queue_places: number,
 *   ahead_ms: number | null,
 * }} Link
 *
 * @typedef {{limit: string, arm: number | null, way_out: string[]}} Held
 *
 * @typedef {{
 *   mode: Mode,
 *   homed: boolean,
 *   robot: string,
 *   xyz_mm: number[] | null,
 *   theta_deg: number[] | null,
 *   command_xyz_mm: number[] | null,
 *   command_theta_deg: number[] | null,
 *   target_xyz_mm: number[] | null,
 *   target_theta_deg: number[] | null,
 *   xyz_speed_share: number[] | null,
 *   theta_speed_share: number[] | null,
 *   margins: number[],
 *   held_by: Held[],
 *   link: Link,
 *   control: {holder: "you" | "another" | null, you: boolean},
 *   stop_reason: string | null,
 *   fault: string | null,
 *   override: number,
 *   next_step: string | null,
 *   board_time_s: number | null,
 *   underruns: number,
 *   capture: {name: string, size: number, lost: number, problem: string | null} | null,
 * }} RobotState
 *
 * The frame a jog is meant in. In `camera` the axes are right, away from the viewer, and up.
 * @typedef {"base" | "joints" | "camera"} Frame
 *
 * A message to the server; every one has a `type`.
 * @typedef {{type: string, [field: string]: unknown}} Message
 *
 * What the scene's panel holds, in plain values (`scene-view.js`).
 * @typedef {{key: string, group: string}} ItemPlace
 * @typedef {[number, number, number]} Rgb
 * @typedef {{kind: "row", text: string, value: string, dot: Rgb | null}
 *   | {kind: "colours", name: string, low: string, high: string, stops: Rgb[]}} ViewRow
 * @typedef {ItemPlace & ({kind: "toggle", label: string, value: boolean}
 *   | {kind: "choice", label: string, value: string, options: string[]}
 *   | {kind: "slider", label: string, value: number, low: number, high: number, step: number}
 *   | {kind: "line", label: string, value: string, hint: string, longest: number}
 *   | {kind: "button", label: string, disabled: boolean}
 *   | {kind: "readout", rows: ViewRow[]})} Item
 *
 * A message from the server.
 * @typedef {{type: "view", items: Item[] | null}} ViewMessage
 * @typedef {{type: "state"} & RobotState} StateMessage
 * @typedef {{type: "refused", to: string, id: string | null, detail: string}} RefusedMessage
 * @typedef {{type: "error", detail: string}} ErrorMessage
 * @typedef {StateMessage | ViewMessage | RefusedMessage | ErrorMessage} ServerMessage
 */

export {};
