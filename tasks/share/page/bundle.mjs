// Makes one HTML file of the page's parts: styles, the program with three.js in it, and the licence of what isn't ours.
// node bundle.mjs OUT.html [NAME]      of NAME.js, NAME.html, look.css and NAME.css; replay if it isn't said
import { readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const name = process.argv[3] ?? "replay";
const result = await build({
  entryPoints: [`${name}.js`],
  bundle: true,
  external: ["fs", "path"],  // what a module that runs under node as well asks for there
  minify: true,
  write: false,
  format: "iife",
  target: ["chrome103", "firefox113", "safari16.4"],  // the first that decompress by themselves
  charset: "ascii",
  legalComments: "none",  // the whole licence stands in the page
});
const licence = "three.js (https://threejs.org)\n\n" + readFileSync("node_modules/three/LICENSE", "utf8");
const parts = {
  "{{style}}": readFileSync("look.css", "utf8") + readFileSync(`${name}.css`, "utf8"),
  "{{program}}": result.outputFiles[0].text,
  "{{licence}}": licence.replace(/[&<>]|[^\x00-\x7f]/gu, (c) => `&#${c.codePointAt(0)};`),
};
let html = readFileSync(`${name}.html`, "utf8");
for (const [mark, text] of Object.entries(parts)) html = html.replace(mark, () => text);
writeFileSync(process.argv[2], html);
