// Renders formulas for scripts/docs/site.py.
//
//     node render_formulas.js FOLDER_OF_KATEX < FORMULAS
//
// Standard input: a JSON list of {"tex": STRING, "display": BOOLEAN}. Standard output: a JSON list of
// {"html": STRING} or {"error": STRING}, in the same order.
"use strict";
const fs = require("fs");
const katex = require(fs.realpathSync(process.argv[2]) + "/dist/katex.js");

const formulas = JSON.parse(fs.readFileSync(0, "utf8"));
const rendered = formulas.map(({ tex, display }) => {
  try {
    return { html: katex.renderToString(tex, { displayMode: display, throwOnError: true, strict: "ignore" }) };
  } catch (error) {
    return { error: error.message };
  }
});
process.stdout.write(JSON.stringify(rendered));
