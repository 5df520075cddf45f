// usage: node check-imports.mjs MODULE.wasm ../page/module.js
// Fails if module.js does not provide all imports of the module: a browser would not start it, and the linker does not check this.
import {readFileSync} from "node:fs";

const [, , wasm, script] = process.argv;
const {hostFunctions} = await import(`data:text/javascript,${encodeURIComponent(readFileSync(script, "utf8"))}`);
const anyPage = new Proxy({}, {get: () => () => 0});
const given = hostFunctions(anyPage, () => null);
const lacking = WebAssembly.Module.imports(new WebAssembly.Module(readFileSync(wasm)))
  .filter(({module, name, kind}) => kind !== "function" || typeof given[module]?.[name] !== "function")
  .map(({module, name}) => `${module}.${name}`);
if (lacking.length > 0) {
  console.error(`${wasm} imports functions that ${script} does not provide: ${lacking.join(", ")}`);
  console.error("A source of the web client uses a function that browsers do not provide. Remove the call, or add the function to hostFunctions().");
  process.exit(1);
}
