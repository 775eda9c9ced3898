// Bundles the page and writes it as C++:  node build.mjs OPENAPI_JSON OUTPUT_CPP
import { readFile, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const kMostGzipped = 300_000;

const [openapi, output] = process.argv.slice(2);
await build({
  entryPoints: { page: "src/main.tsx" },
  outdir: "dist",
  bundle: true,
  minify: true,
  target: "es2020",
  jsx: "automatic",
  jsxImportSource: "preact",
  legalComments: "none",
  logLevel: "warning",
});

const assets = [
  ["/index.html", "text/html; charset=utf-8", "src/index.html"],
  ["/page.js", "text/javascript; charset=utf-8", "dist/page.js"],
  ["/page.css", "text/css; charset=utf-8", "dist/page.css"],
  ["/icon.svg", "image/svg+xml", "src/icon.svg"],
  ["/api/v1/openapi.json", "application/json", openapi],
];

/** A byte string as C++ takes it; octal, because hexadecimal escapes have no end. */
function literal(bytes) {
  let text = '"';
  let column = 0;
  for (const byte of bytes) {
    const plain = byte >= 0x20 && byte < 0x7f && byte !== 0x22 && byte !== 0x5c && byte !== 0x3f;
    text += plain ? String.fromCharCode(byte) : "\\" + byte.toString(8).padStart(3, "0");
    if (++column % 4000 === 0) text += '"\n    "';
  }
  return text + '"';
}

let gzipped = 0;
let code = `// Made by service/web/page/build.mjs.
#include "telltale/service/web/page_assets.hpp"

namespace telltale {
namespace {

using namespace std::string_view_literals;

`;
const entries = [];
for (const [index, [path, type, file]] of assets.entries()) {
  const bytes = await readFile(file);
  if (path !== "/api/v1/openapi.json") gzipped += gzipSync(bytes, { level: 9 }).length;
  code += `constexpr std::string_view kBody${index} =\n    ${literal(bytes)}sv;\n\n`;
  entries.push(`    {"${path}", "${type}", kBody${index}},\n`);
}
code += `constexpr PageAsset kAssets[] = {\n${entries.join("")}};

}  // namespace

std::span<const PageAsset> PageAssets() {
  return kAssets;
}

}  // namespace telltale
`;
if (gzipped > kMostGzipped) {
  console.error(`the page takes ${gzipped} bytes gzipped; it may take ${kMostGzipped}`);
  process.exit(1);
}
await writeFile(output, code);
console.log(`page: ${gzipped} bytes gzipped`);
