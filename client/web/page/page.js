// The page around the client: WebSockets to the gateway, keyboard, pointer, touch, and what is beside the picture.

import {loadClient} from "./module.js";
import {Picture} from "./picture.js";
import {Sounds} from "./sound.js";

const element = (id) => document.getElementById(id);
const picture = new Picture(element("picture"));
const sounds = new Sounds();
const door = element("door");
const line = element("line");
const address = new URLSearchParams(location.search);
const touch = matchMedia("(pointer: coarse)").matches || address.has("touch");
const room = address.get("room") ?? "";  // ?room=NAME: where to begin

let client = null;
let joined = false;  // there has been a picture of the game
let server = {name: "", key: ""};

// ---- streams ------------------------------------------------------------------------------------------------------

const sockets = new Map();  // by the client's number

const port = {
  open(stream) {
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/play`, ["naiad.1"]);
    socket.binaryType = "arraybuffer";
    sockets.set(stream, socket);
    const is = () => sockets.get(stream) === socket;
    socket.onopen = () => is() && later(() => client.opened(stream));
    socket.onmessage = ({data}) => {
      if (!is() || client === null) return;
      client.received(stream, new Uint8Array(data));
      client.update();
    };
    socket.onclose = ({code, reason}) => {
      if (!is() || client === null) return;
      sockets.delete(stream);
      client.closed(stream, code, reason);
      later(() => client.update());
    };
  },
  send(stream, message) {
    const socket = sockets.get(stream);
    if (socket?.readyState === WebSocket.OPEN) socket.send(message);
  },
  unsent: (stream) => sockets.get(stream)?.bufferedAmount ?? 0,
  close(stream) {
    const socket = sockets.get(stream);
    sockets.delete(stream);
    socket?.close(1000);
  },
  keep(token) {
    if (token === "") sessionStorage.removeItem("naiad.token");
    else sessionStorage.setItem("naiad.token", token);
  },
  sound: (label, action, flags) => sounds.take(label, action, flags),
};

/** The client is never called from inside a call of its own. */
function later(call) {
  queueMicrotask(() => client !== null && call());
}

// ---- the picture --------------------------------------------------------------------------------------------------

function fit() {
  const stage = element("stage");
  const view = client?.view() ?? {columns: 80, rows: 24};
  // The view, its frame, and the line of status.
  const size = picture.fit(stage.clientWidth, stage.clientHeight, view.columns + 2, view.rows + 3);
  client?.resize(size.columns, size.rows);
  return size;
}

let view = "";

function frame() {
  requestAnimationFrame(frame);
  if (client === null) return;
  client.update();
  if (client.compose()) picture.show(client.picture());
  const {columns, rows} = client.view();
  if (view !== `${columns}x${rows}`) {
    view = `${columns}x${rows}`;
    fit();
  }
  const writing = client.writing();
  if (writing !== (document.activeElement === line)) {
    if (writing) {
      line.value = "";
      line.focus();
    } else if (door.hidden) {
      picture.canvas.focus({preventScroll: true});
    }
  }
  notice(client.state());
}

// ---- joining and leaving ------------------------------------------------------------------------------------------

function notice(state) {
  if (state === "playing" && !joined) {
    joined = true;
    door.hidden = true;
    document.body.classList.add("playing");
    picture.canvas.focus({preventScroll: true});
  }
  if (state === "joining" || state === "playing") {
    if (state === "joining") say(client.sentence() || "Joining …");
    return;
  }
  const sentence = client.sentence();
  client = null;
  for (const stream of [...sockets.keys()]) port.close(stream);
  joined = false;
  sounds.stopAll();
  document.body.classList.remove("playing");
  picture.redraw();
  if (state === "refused" && /password/i.test(sentence)) element("secret").hidden = false;
  say(state === "left" ? "You left." : sentence);
  element("play").disabled = false;
  element("play").textContent = state === "left" ? "Play again" : "Try again";
  door.hidden = false;
}

function say(sentence) {
  if (element("said").textContent !== sentence) element("said").textContent = sentence;
}

let wasm = null;

/**
 * Make this tab's storage its own. A tab that was duplicated begins with a copy of that of the one it was made from, which
 * plays on: it must not take its session.
 */
async function claimTab() {
  const mine = sessionStorage.getItem("naiad.tab");
  // A page that is loaded again may come before the one that goes has let go.
  for (let attempt = 0; mine !== null && attempt < 10; ++attempt) {
    if (await hold(mine)) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  sessionStorage.removeItem("naiad.token");
  const tab = crypto.getRandomValues(new Uint32Array(4)).join("-");
  sessionStorage.setItem("naiad.tab", tab);
  await hold(tab);
}

/** Hold a lock for as long as the page lives; false if another page has it. */
function hold(tab) {
  if (navigator.locks === undefined) return Promise.resolve(true);  // as in a page that came without encryption
  return new Promise((resolve) => {
    navigator.locks.request(`naiad.${tab}`, {ifAvailable: true}, (lock) => {
      resolve(lock !== null);
      return lock !== null ? new Promise(() => {}) : undefined;
    });
  });
}

async function join() {
  element("play").disabled = true;
  say("Joining …");
  try {
    client = await loadClient(await (wasm ?? fetchModule()), port);
  } catch (error) {
    client = null;
    element("play").disabled = false;
    return say(`The client could not be loaded: ${error.message}`);
  } finally {
    wasm = null;
  }
  const size = fit();
  client.start({
    name: element("name").value,
    password: element("password").value,
    token: sessionStorage.getItem("naiad.token") ?? "",
    server: server.name || location.host,
    room,
    columns: size.columns,
    rows: size.rows,
  });
  element("password").value = "";
}

async function fetchModule() {
  const response = await fetch("client.wasm");
  if (!response.ok) throw new Error(`the gateway says ${response.status}`);
  return response;
}

// ---- keyboard -----------------------------------------------------------------------------------------------------

const down = 0, again = 1, up = 2;

function modifiers(event) {
  return (event.shiftKey ? 1 : 0) | (event.altKey ? 2 : 0) | (event.ctrlKey ? 4 : 0) | (event.metaKey ? 8 : 0);
}

/** The browser's own: shortcuts, and keys that only the browser should have. */
function isBrowsers(event) {
  if (event.ctrlKey && !event.altKey && !event.metaKey && event.key === "]") return false;
  if (event.ctrlKey && event.altKey) return event.key.length !== 1;  // AltGr types characters
  return event.ctrlKey || event.metaKey || event.altKey || ["F5", "F11", "F12", "Dead", "Process", "Unidentified"].includes(event.key);
}

function takeKey(event, action) {
  if (client === null || event.isComposing || isBrowsers(event) && action !== up) return;
  sounds.wake();
  client.key(event.key, event.code, action, modifiers(event));
  event.preventDefault();
}

picture.canvas.addEventListener("keydown", (event) => takeKey(event, event.repeat ? again : down));
picture.canvas.addEventListener("keyup", (event) => takeKey(event, up));
picture.canvas.addEventListener("blur", () => client?.blur());
addEventListener("blur", () => client?.blur());
document.addEventListener("visibilitychange", () => document.hidden && client?.blur());

// The line of chat. Or, on a phone whose keyboard was brought up for the game, keys.
line.addEventListener("keydown", (event) => {
  if (client === null || event.isComposing) return;
  if (!client.writing() || event.key === "Enter" || event.key === "Escape" || event.ctrlKey && event.key === "]") takeKey(event, down);
});
line.addEventListener("keyup", (event) => client !== null && !client.writing() && takeKey(event, up));
line.addEventListener("input", () => {
  if (client === null) return;
  if (client.writing()) return client.chat(line.value);
  // Keyboards of phones do not say which key it was, only what was typed.
  for (const ch of line.value) tap(ch === "\n" ? "Enter" : ch);
  line.value = "";
});

function tap(key) {
  client.key(key, `Tap${key}`, down, 0);
  setTimeout(() => client?.key(key, `Tap${key}`, up, 0), 60);
}

// ---- pointer ------------------------------------------------------------------------------------------------------

const buttons = [0, 2, 1];  // left, middle, right: of PointerEvent, as df::Mouse::Button
let held = -1;

function takePointer(event, action, button) {
  if (client === null) return;
  const box = picture.canvas.getBoundingClientRect();
  const x = Math.floor((event.clientX - box.left) / box.width * picture.columns);
  const y = Math.floor((event.clientY - box.top) / box.height * picture.rows);
  client.mouse(x, y, button, action);
}

picture.canvas.addEventListener("pointerdown", (event) => {
  picture.canvas.focus({preventScroll: true});
  sounds.wake();
  if (event.button > 2) return;
  picture.canvas.setPointerCapture(event.pointerId);
  held = buttons[event.button];
  takePointer(event, 0, held);
  event.preventDefault();
});
picture.canvas.addEventListener("pointermove", (event) => takePointer(event, held >= 0 ? 1 : 2, held));
for (const end of ["pointerup", "pointercancel"]) {
  picture.canvas.addEventListener(end, (event) => {
    takePointer(event, 3, held);
    held = -1;
  });
}
picture.canvas.addEventListener("contextmenu", (event) => event.preventDefault());

// ---- the pad of touch screens -------------------------------------------------------------------------------------

const letters = {ArrowUp: "w", ArrowLeft: "a", ArrowDown: "s", ArrowRight: "d"};
let isLetters = false;

for (const button of document.querySelectorAll("#pad button[data-key]")) {
  const send = (action) => {
    const key = isLetters ? letters[button.dataset.key] ?? button.dataset.key : button.dataset.key;
    client?.key(key, `Pad${button.dataset.key}`, action, 0);
    button.classList.toggle("down-now", action !== up);
  };
  button.addEventListener("pointerdown", (event) => {
    sounds.wake();
    button.setPointerCapture(event.pointerId);
    event.preventDefault();
    send(down);
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    button.addEventListener(end, () => button.classList.contains("down-now") && send(up));
  }
  button.addEventListener("contextmenu", (event) => event.preventDefault());
}
element("switch").addEventListener("click", () => {
  isLetters = !isLetters;
  element("switch").textContent = isLetters ? "Arrows" : "WASD";
});

// ---- beside the picture -------------------------------------------------------------------------------------------

for (const [id, letter] of [["say", "t"], ["players", "p"], ["help", "h"], ["leave", "q"]]) {
  element(id).addEventListener("click", () => {
    sounds.wake();
    client?.command(letter);
    if (letter !== "t") picture.canvas.focus({preventScroll: true});
    else line.focus();  // now, or a phone shows no keyboard
  });
}
element("sound").addEventListener("click", () => {
  element("sound").setAttribute("aria-pressed", String(sounds.toggle()));
  picture.canvas.focus({preventScroll: true});
});
element("keyboard").addEventListener("click", () => line.focus());

door.addEventListener("submit", async (event) => {
  event.preventDefault();
  if (client !== null) return;
  sounds.wake();
  localStorage.setItem("naiad.name", element("name").value);
  await join();
});

/** What stands behind the # of the address: a link's key, so that a page of another game is not taken for it. */
function isOtherServer() {
  const key = location.hash.slice(1).toLowerCase();
  return key !== "" && server.key !== "" && key !== server.key;
}

/** As dfclient takes HOST/ROOM (SafeText.h). */
function isRoomName(name) {
  return /^[A-Za-z0-9][A-Za-z0-9._-]{0,31}$/.test(name);
}

async function begin() {
  element("unable").remove();
  element("sound").setAttribute("aria-pressed", String(sounds.on));
  element("name").value = localStorage.getItem("naiad.name") ?? "";
  element("pad").hidden = element("keyboard").hidden = !touch;
  if (typeof WebAssembly !== "object") return say("This browser has no WebAssembly, which the game needs. A newer one has.");
  wasm = fetchModule().catch(() => null);
  try {
    server = await (await fetch("server")).json();
  } catch {
    return say("The game's gateway does not answer. Load the page again in a moment.");
  }
  element("title").textContent = server.name || "Naiad";
  document.title = server.name ? `${server.name} – Naiad` : "Naiad";
  if (room !== "" && !isRoomName(room)) {
    return say("The address of this page names no room: 1 to 32 of a-z, A-Z, 0-9, '-', '_' and '.', beginning with a letter or digit, are wanted behind room=.");
  }
  if (server.link) element("terminal").textContent = `dfclient ${server.link}`;
  if (isOtherServer()) return say("This address was made for another game than the one that is here now.");
  await Promise.all([document.fonts.load('16px "Naiad Mono"'), claimTab()]);
  // A tab that was loaded again plays on.
  if (sessionStorage.getItem("naiad.token") !== null && element("name").value !== "") return join();
  element("play").disabled = false;
  if (element("name").value === "") element("name").focus();
  else element("play").focus();
}

new ResizeObserver(fit).observe(element("stage"));
new Worker("clock.js").onmessage = () => client?.update();
requestAnimationFrame(frame);
await begin();

// For scripts that test the page.
window.naiad = {get client() { return client; }, picture};
