// Runs a WebAssembly program that only prints: node run.mjs PROGRAM.wasm
import {readFile} from "node:fs/promises";
import {WASI} from "node:wasi";

const module = await WebAssembly.compile(await readFile(process.argv[2]));
// Stubs for functions that are linked but must not be called, such as those that throw.
const env = {};
for (const {module: from, name} of WebAssembly.Module.imports(module)) {
  if (from === "env") env[name] = () => { throw new Error(name + " was called"); };
}
const wasi = new WASI({version: "preview1", returnOnExit: true});
const instance = await WebAssembly.instantiate(module, {env, wasi_snapshot_preview1: wasi.wasiImport});
process.exitCode = wasi.start(instance);
