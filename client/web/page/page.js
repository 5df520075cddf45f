// The page around the client: WebSockets to the gateway, keyboard, pointer, touch, buttons and forms.

import {loadClient, streamAddress} from "./module.js";
import {Picture} from "./picture.js";
import {Sounds} from "./sound.js";

const element = (id) => document.getElementById(id);
const picture = new Picture(element("picture"));
const sounds = new Sounds();
const door = element("door");
const line = element("line");
const address = new URLSearchParams(location.search);
const touch = matchMedia("(pointer: coarse)").matches || address.has("touch");
const room = address.get("room") ?? "";  // ?room=NAME: the first room
const tokenKey = "naiad.token" + new URL(".", location.href).pathname.slice(1);  // each path is another game

let client = null;
let joined = false;  // a picture of the game has been shown
let server = {name: "", key: ""};

// ---- streams ------------------------------------------------------------------------------------------------------

const sockets = new Map();  // by stream number

const port = {
  open(stream) {
    const socket = new WebSocket(streamAddress(location.href), ["naiad.1"]);
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
    if (token === "") sessionStorage.removeItem(tokenKey);
    else sessionStorage.setItem(tokenKey, token);
  },
  sound: (label, action, flags) => sounds.take(label, action, flags),
};

/** Calls the client later, because it must not be called during one of its own calls. */
function later(call) {
  queueMicrotask(() => client !== null && call());
}

// ---- the picture --------------------------------------------------------------------------------------------------

function fit() {
  const stage = element("stage");
  const view = client?.view() ?? {columns: 80, rows: 24};
  // The size includes the view, its frame and the status line.
  const size = picture.fit(stage.clientWidth, stage.clientHeight, view.columns + 2, view.rows + 3);
  client?.resize(size.columns, size.rows);
  return size;
}

let view = "";
let wrote = false;  // the chat line was open in the last frame

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
  if (writing !== wrote) {
    line.value = tapped = "";
    if (!writing && door.hidden) picture.canvas.focus({preventScroll: true});
  }
  wrote = writing;
  if (writing && document.activeElement !== line) line.focus();
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
    if (state === "joining") say(client.message() ? `${client.message()} (Retrying.)` : "Joining …");
    return;
  }
  const message = client.message();
  client = null;
  for (const stream of [...sockets.keys()]) port.close(stream);
  joined = false;
  sounds.stopAll();
  document.body.classList.remove("playing");
  picture.redraw();
  if (state === "refused" && /password/i.test(message)) element("secret").hidden = false;
  say(state === "left" ? "You left." : message);
  element("play").disabled = false;
  element("play").textContent = state === "left" ? "Play again" : "Try again";
  door.hidden = false;
}

function say(message) {
  if (element("said").textContent !== message) element("said").textContent = message;
}

let wasm = null;

/**
 * Makes this tab's storage its own. A duplicated tab starts with a copy of the original tab's storage, but must not
 * take over the session that the original is playing.
 */
async function claimTab() {
  const mine = sessionStorage.getItem("naiad.tab");
  // During a reload, the old page may not have released its lock yet.
  for (let attempt = 0; mine !== null && attempt < 10; ++attempt) {
    if (await hold(mine)) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  sessionStorage.removeItem(tokenKey);
  const tab = crypto.getRandomValues(new Uint32Array(4)).join("-");
  sessionStorage.setItem("naiad.tab", tab);
  await hold(tab);
}

/** Takes a lock for the lifetime of the page. Resolves to false if another page has the lock. */
function hold(tab) {
  if (navigator.locks === undefined) return Promise.resolve(true);  // e.g. a page loaded without encryption
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
    token: sessionStorage.getItem(tokenKey) ?? "",
    server: server.name || location.host,
    room,
    columns: size.columns,
    rows: size.rows,
  });
  element("password").value = "";
}

async function fetchModule() {
  const response = await fetch("client.wasm");
  if (!response.ok) throw new Error(`the gateway answered with HTTP status ${response.status}`);
  return response;
}

// ---- keyboard -----------------------------------------------------------------------------------------------------

const down = 0, again = 1, up = 2;

function modifiers(event) {
  return (event.shiftKey ? 1 : 0) | (event.altKey ? 2 : 0) | (event.ctrlKey ? 4 : 0) | (event.metaKey ? 8 : 0);
}

/** True for Ctrl-G and Ctrl-]; in other scripts than Latin, by position. */
function isMenuKey(event) {
  const code = event.key > "\u0370" ? event.code : "";
  return event.ctrlKey && !event.altKey && !event.metaKey && (["g", "G", "]"].includes(event.key) || ["KeyG", "BracketRight"].includes(code));
}

/** True for the browser's shortcuts and other keys that the game must not get. */
function isBrowsers(event) {
  if (isMenuKey(event)) return false;
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
for (const target of [picture.canvas, line, window]) target.addEventListener("blur", () => client?.blur());
document.addEventListener("visibilitychange", () => document.hidden && client?.blur());

// The text field is the chat line or, if a phone's keyboard was opened for the game, takes keys for the game.
line.addEventListener("keydown", (event) => {
  if (client === null || event.isComposing) return;
  if (!client.writing() || event.key === "Enter" || event.key === "Escape" || isMenuKey(event)) takeKey(event, event.repeat ? again : down);
});
line.addEventListener("keyup", (event) => client !== null && !client.writing() && takeKey(event, up));
// Phone keyboards report only the typed text, not the key, and during a composition all of its text at each change.
let tapped = "";  // text of the field whose keys the game has got
line.addEventListener("input", (event) => {
  if (client === null) return;
  if (client.writing()) return client.chat(line.value);
  let same = 0;
  while (same < tapped.length && tapped[same] === line.value[same]) ++same;
  for (const ch of line.value.slice(same)) tap(ch === "\n" ? "Enter" : ch);
  if (event.isComposing) tapped = line.value;
  else line.value = tapped = "";
});
line.addEventListener("compositionend", () => client?.writing() || (line.value = tapped = ""));

function tap(key) {
  client.key(key, `Tap${key}`, down, 0);
  setTimeout(() => client?.key(key, `Tap${key}`, up, 0), 60);
}

// ---- pointer ------------------------------------------------------------------------------------------------------

const buttons = [0, 2, 1];  // PointerEvent's left, middle and right button as df::Mouse::Button
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

// ---- buttons and the join form ------------------------------------------------------------------------------------

for (const [id, letter] of [["say", "t"], ["players", "p"], ["rooms", "r"], ["help", "h"], ["leave", "q"]]) {
  element(id).addEventListener("click", () => {
    sounds.wake();
    client?.command(letter);
    if (letter !== "t") picture.canvas.focus({preventScroll: true});
    else line.focus();  // immediately, otherwise a phone does not open its keyboard
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

/** True if the address has the key of another server behind its #, i.e. the link was for another game. */
function isOtherServer() {
  const key = location.hash.slice(1).toLowerCase();
  return key !== "" && server.key !== "" && key !== server.key;
}

/** Like isRoomName() in SafeText.h. */
function isRoomName(name) {
  return /^[A-Za-z0-9][A-Za-z0-9._-]{0,31}$/.test(name);
}

async function begin() {
  element("unable").remove();
  element("sound").setAttribute("aria-pressed", String(sounds.on));
  element("name").value = localStorage.getItem("naiad.name") ?? "";
  element("pad").hidden = element("keyboard").hidden = !touch;
  if (typeof WebAssembly !== "object") return say("This browser lacks WebAssembly, which the game needs. Please update it.");
  wasm = fetchModule().catch(() => null);
  try {
    server = await (await fetch("server")).json();
  } catch {
    return say("The game's gateway does not answer. Reload the page in a moment.");
  }
  element("title").textContent = server.name || "Naiad";
  document.title = server.name ? `${server.name} – Naiad` : "Naiad";
  if (room !== "" && !isRoomName(room)) {
    return say("The address of this page has an invalid room name. Expected after room=: 1 to 32 of a-z, A-Z, 0-9, '-', '_' and '.', beginning with a letter or digit.");
  }
  if (server.link) element("terminal").textContent = `dfclient ${server.link}`;
  if (isOtherServer()) return say("This link belongs to a different server.");
  await Promise.all([document.fonts.load('16px "Naiad Mono"'), claimTab()]);
  // A reloaded tab resumes its session.
  if (sessionStorage.getItem(tokenKey) !== null && element("name").value !== "") return join();
  element("play").disabled = false;
  if (element("name").value === "") element("name").focus();
  else element("play").focus();
}

new ResizeObserver(fit).observe(element("stage"));
new Worker("clock.js").onmessage = () => client?.update();
requestAnimationFrame(frame);
await begin();

// Used by scripts that test the page.
window.naiad = {get client() { return client; }, picture};
