// The page with the map, without VS Code.
"use strict";

const assert = require("node:assert");
const Module = require("node:module");
const test = require("node:test");

const load = Module._load;
Module._load = (name, ...rest) => (name.startsWith("vscode") ? { LanguageClient: class {} } : load(name, ...rest));
const { page } = require("../extension.js");
Module._load = load;

test("the picture stands in the page, and nothing in it can run", () => {
  const html = page({ svg: "<svg></svg>" });
  assert.ok(html.includes("<body><svg></svg></body>"));
  assert.ok(html.includes("default-src 'none'"));
  assert.ok(!html.includes("script-src"));
});

test("why there is no map is told as text", () => {
  assert.ok(page({ message: "a <b> & c" }).includes("a &lt;b&gt; &amp; c"));
});
