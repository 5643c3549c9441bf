/** Puts the console together. */

import { get, post } from "./api.js";
import { Connection } from "./connection.js";
import { byId, make, onPress } from "./dom.js";
import { SceneFrame } from "./frame.js";
import { Hands } from "./hands.js";
import { JogChoice } from "./jog-choice.js";
import { JogPad } from "./jog-pad.js";
import { Jogging } from "./jogging.js";
import { keySource, listenToKeys } from "./keyboard.js";
import { MessageBox } from "./message-box.js";
import { LinkChoice } from "./link-choice.js";
import { addLinkFacts } from "./link-facts.js";
import { addMoveTo } from "./move-to.js";
import { Notices } from "./notices.js";
import { addOverride } from "./override.js";
import { Pose } from "./pose.js";
import { addPower } from "./power.js";
import { watchPresence } from "./presence.js";
import { Readouts } from "./readouts.js";
import { addRobotChoice } from "./robot-choice.js";
import { readRobot } from "./robot.js";
import { SceneView } from "./scene-view.js";
import { Status } from "./status.js";
import { Stopper } from "./stop.js";
import { Store } from "./store.js";
import { ThemeChoice } from "./theme.js";
import { Views } from "./views.js";
import { ViserPanel } from "./viser-panel.js";

/** How often the page looks whether its numbers have grown old. */
const WATCH_MS = 250;

const THEMES = {
  auto: { sign: "◐", name: "Auto" },
  light: { sign: "○", name: "Light" },
  dark: { sign: "●", name: "Dark" },
};

const store = new Store();
const notices = new Notices(() => store.changed());
/** @param {Promise<unknown>} action */
const watch = (action) => void notices.watch(action);

const connection = new Connection({ opened, closed, received });
const hands = new Hands({ connection, store });
const stopper = new Stopper({ connection, hands, notices, store });
const choice = new JogChoice();
const jogging = new Jogging({ store, hands, choice, notices });
const views = new Views(() => {
  hands.endJog();
  store.changed();
});
const theme = new ThemeChoice(themeChanged);
const links = new LinkChoice({ store, watch });
const panel = new ViserPanel();
const sceneView = new SceneView({ choose: (item, value) => connection.send({ type: "show", item, value }) });

new Status({ store, watch });
new Readouts(store);
new JogPad({ store, hands, choice, press: (source, wish) => jogging.press(source, wish) });
const pose = new Pose({ store, watch });
new MessageBox({
  store,
  notices,
  steps: {
    connect: () => views.show("setup"),
    enable: () => watch(post("enable")),
    home: () => watch(post("home")),
    reset: () => watch(post("reset")),
  },
});
addPower({ store, watch });
addOverride({ store, connection });
addMoveTo({ store, watch });
addRobotChoice({ store, watch });
addLinkFacts({ store });

/** @param {import("./stop.js").StopKind} kind */
const stop = (kind) => {
  stopper.stop(kind);
  pose.letGo();
};
onPress(byId("stop", HTMLButtonElement), () => stop("stop"));
onPress(byId("estop", HTMLButtonElement), () => stop("estop"));

const keys = {
  stop: () => stop("stop"),
  shown: () => views.jogShown,
  jog: (/** @type {KeyboardEvent} */ event) => jogging.key(event, keySource(event)),
  release: (/** @type {string} */ source) => hands.release(source),
  releaseModifier: (/** @type {string} */ modifier) => hands.releaseModifier(modifier),
  interrupt: () => hands.endJog(),
};
const letGo = () => hands.letGo();

listenToKeys(window, keys, { inFrame: false });
watchPresence(window, letGo);
const frame = new SceneFrame(byId("scene", HTMLIFrameElement), {
  watchers: [
    (view, signal) => listenToKeys(view, keys, { inFrame: true, signal }),
    (view, signal) => watchPresence(view, letGo, signal),
    (view, signal) => panel.watch(view, signal),
    watchPointer,
  ],
  reloaded: letGo,
});

const themeButton = byId("theme", HTMLButtonElement);
themeButton.addEventListener("click", () => theme.next());
themeChanged();

store.addView(() => panel.setInert(store.stale || store.state?.control.holder === "another"));
store.onState(({ robot }) => {
  if (robot !== store.robot?.name) void loadRobot();
});
setInterval(() => store.changed(), WATCH_MS);
connection.connect();

/** @param {number} away ms that the connection was lost; 0 the first time */
function opened(away) {
  store.connected = true;
  tellTheme();
  frame.mend();
  void loadRobot();
  links.refresh().catch(() => notices.say("warn", "The list of links could not be read."));
  if (away > 0) {
    const seconds = (away / 1000).toFixed(1);
    notices.say("warn", `The server was lost for ${seconds} s and is back. Nothing was resumed.`);
  }
  store.changed();
}

function closed() {
  store.connected = false;
  hands.letGo();
  store.changed();
}

/** @param {import("./types.js").ServerMessage} message */
function received(message) {
  if (message.type === "state") {
    store.receive(message);
  } else if (message.type === "view") {
    sceneView.show(message.items);
  } else if (message.type === "refused") {
    const wasHeld = hands.refused(message.id);
    const isBeat = message.to === "drag_alive" || message.to === "jog" || message.to === "jog_end";
    if (wasHeld || !isBeat) notices.say("warn", message.detail);
  } else if (message.type === "error") {
    notices.say("warn", message.detail);
  }
}

let loadingRobot = false;

async function loadRobot() {
  if (loadingRobot) return;
  loadingRobot = true;
  try {
    store.robot = readRobot(await get("robot"));
    store.changed();
  } catch {
    notices.say("warn", "The robot's limits could not be read.");
  } finally {
    loadingRobot = false;
  }
}

function themeChanged() {
  const { sign, name } = THEMES[theme.theme];
  themeButton.replaceChildren(sign, make("span", { class: "wide" }, ` ${name}`));
  themeButton.setAttribute("aria-label", `Theme: ${theme.theme}`);
  themeButton.title = "Theme: as the system has it, light, or dark";
  tellTheme();
}

function tellTheme() {
  connection.send({ type: "theme", dark: theme.dark });
}

/**
 * Holds a drag alive while the pointer is down in the scene.
 *
 * @param {Window} view
 * @param {AbortSignal} signal
 */
function watchPointer(view, signal) {
  const options = { capture: true, signal };
  view.addEventListener("pointerdown", (event) => hands.grab(event.pointerId), options);
  view.addEventListener("pointerup", (event) => hands.drop(event.pointerId), options);
  view.addEventListener("pointercancel", () => hands.loseDrag(), options);
}
