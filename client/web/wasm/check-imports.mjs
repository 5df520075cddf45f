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
  console.error(`${wasm} calls what ${script} does not have: ${lacking.join(", ")}`);
  console.error("A source of the page's client uses something that a browser does not give. Leave it out, or add it to hostFunctions().");
  process.exit(1);
}
