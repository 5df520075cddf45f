// Loads client.wasm and passes strings and bytes to and from it. client/web/WebMain.cpp defines its exports.

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** Returns the WASI functions that the module uses. Times are in nanoseconds. */
function wasi(memory) {
  const view = () => new DataView(memory().buffer);
  return {
    clock_time_get(_clock, _precision, out) {
      view().setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    // The module writes a text only when it fails; the console shows the text.
    fd_write(_fd, vectors, count, out) {
      let written = 0;
      for (let i = 0; i < count; ++i) {
        const from = view().getUint32(vectors + 8 * i, true);
        const size = view().getUint32(vectors + 8 * i + 4, true);
        console.warn(decoder.decode(new Uint8Array(memory().buffer, from, size)));
        written += size;
      }
      view().setUint32(out, written, true);
      return 0;
    },
    fd_close: () => 0,
    fd_seek: () => 0,
    proc_exit(code) {
      throw new Error(`The client ended with exit code ${code}.`);
    },
  };
}

/** Returns the module's imports. `memory()` returns the module's memory; `page`: see loadClient(). */
export function hostFunctions(page, memory) {
  const bytes = (from, size) => new Uint8Array(memory().buffer, from, size);
  const text = (from, size) => decoder.decode(bytes(from, size));
  return {
    page: {
      open: page.open,
      // Passes a copy, because the socket may send it after the module's memory has changed.
      send: (stream, from, size) => page.send(stream, bytes(from, size).slice()),
      unsent: page.unsent,
      close: page.close,
      keep: (from, size) => page.keep(text(from, size)),
      sound: (from, size, action, flags) => page.sound(text(from, size), action, flags),
    },
    wasi_snapshot_preview1: wasi(memory),
    // Asio would open a socket to get the name of a network interface, which does not exist here.
    env: {emscripten_notify_memory_growth() {}, __syscall_socket: () => -1},
  };
}

/** Returns the address of the WebSocket for a page, which a proxy may serve below a path. */
export function streamAddress(page) {
  return new URL("play", page).href.replace(/^http/, "ws");
}

/**
 * Starts the module. `page` has open(stream), send(stream, Uint8Array), unsent(stream), close(stream), keep(text)
 * and sound(label, action, flags). Returns the client.
 */
export async function loadClient(source, page) {
  let exports = null;
  const memory = () => exports.memory;
  const bytes = (from, size) => new Uint8Array(memory().buffer, from, size);
  const text = (from, size) => decoder.decode(bytes(from, size));
  const imports = hostFunctions(page, memory);
  const {instance} = source instanceof Response && WebAssembly.instantiateStreaming
    ? await WebAssembly.instantiateStreaming(source, imports)
    : await WebAssembly.instantiate(source instanceof Response ? await source.arrayBuffer() : source, imports);
  exports = instance.exports;
  exports._initialize?.();
  const capacity = 65536;
  const put = (value, at = 0) => {
    const data = typeof value === "string" ? encoder.encode(value) : value;
    const size = Math.min(data.length, capacity - at);
    bytes(exports.buffer() + at, size).set(size < data.length ? data.subarray(0, size) : data);
    return size;
  };
  return {
    start({name, password, token, server, room, columns, rows}) {
      [name, password, token, server, room].forEach((value, which) => exports.option(which, put(value ?? "")));
      exports.start(columns, rows);
    },
    opened: (stream) => exports.opened(stream),
    received: (stream, message) => exports.received(stream, put(message)),
    closed: (stream, code, reason) => exports.closed(stream, code, put(reason)),
    key(key, code, action, modifiers) {
      const size = put(key);
      exports.key(size, put(code, size), action, modifiers);
    },
    mouse: (x, y, button, action) => exports.mouse(x, y, button, action),
    command: (letter) => exports.command(letter.charCodeAt(0)),
    chat: (line) => exports.chat(put(line)),
    blur: () => exports.blur(),
    resize: (columns, rows) => exports.resize(columns, rows),
    update: () => exports.update(),
    compose: () => exports.compose() === 1,
    /** Returns the newest picture, which is valid until the next call. */
    picture() {
      const columns = exports.columns();
      const rows = exports.rows();
      return {columns, rows, cells: new Uint32Array(memory().buffer, exports.cells(), columns * rows), cursor: exports.cursor()};
    },
    state: () => ["joining", "playing", "refused", "over", "left"][exports.state()],
    writing: () => exports.writing() === 1,
    message() {
      const size = exports.sentence_size();
      return text(exports.message(), size);
    },
    view() {
      const packed = exports.view();
      return {columns: packed & 0xffff, rows: packed >> 16};
    },
    exports,
  };
}
