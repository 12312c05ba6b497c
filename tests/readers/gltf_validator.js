// Validates a glTF file by the Khronos validator and prints the numbers of its messages.
//
//     node tests/readers/gltf_validator.js FILE
//
// Exit code 77 says that the npm package `gltf-validator` is missing (NODE_PATH names where packages are).

const fs = require("fs");
const path = require("path");

let validator;
try {
  validator = require("gltf-validator");
} catch (missing) {
  console.log("gltf-validator is missing");
  process.exit(77);
}

const file = process.argv[2];
const load = (uri) => fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri))).then((bytes) => new Uint8Array(bytes));
validator
  .validateBytes(new Uint8Array(fs.readFileSync(file)), { externalResourceFunction: load, uri: path.basename(file) })
  .then((report) => {
    console.log(JSON.stringify({ issues: report.issues, info: report.info }));
    process.exit(report.issues.numErrors + report.issues.numWarnings > 0 ? 1 : 0);
  });
