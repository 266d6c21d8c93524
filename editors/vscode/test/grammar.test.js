// The TextMate grammar, in the engine that VS Code colours with.
"use strict";

const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const FILE = path.join(__dirname, "..", "syntaxes", "pursue.tmLanguage.json");

async function grammar() {
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(FILE, "utf8"), FILE),
  });
  return registry.loadGrammar("source.pursue");
}

const loaded = grammar();

/** [word, scope] of each piece of a text. */
async function coloured(text) {
  const rules = await loaded;
  const found = [];
  let stack = textmate.INITIAL;
  for (const line of text.split("\n")) {
    const result = rules.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const token of result.tokens) {
      const word = line.slice(token.startIndex, token.endIndex);
      if (word.trim()) found.push([word, token.scopes[token.scopes.length - 1]]);
    }
  }
  return found;
}

test("statements, names, numbers and comments have their colours", async () => {
  const text = 'agent"my-bot" mobile 3 location agent_1 /* 1\n2 */ can_do do-it // end\ncontrol : A<> x';
  const scopes = (await coloured(text)).map(([word, scope]) => [word.trim(), scope.replace(".pursue", "")]);
  assert.deepStrictEqual(scopes, [
    ["agent", "keyword.control"],
    ['"my-bot"', "string.quoted.double"],
    ["mobile", "keyword.other"],
    ["3", "constant.numeric"],
    ["location", "keyword.other"],
    ["agent_1", "variable.other"],
    ["/*", "comment.block"],
    ["1", "comment.block"],
    ["2", "comment.block"],
    ["*/", "comment.block"],
    ["can_do", "keyword.other"],
    ["do-it", "variable.other"],
    ["// end", "comment.line.double-slash"],
    ["control : A<> x", "meta.preprocessor"],
  ]);
});

test("a pose is told from other comments", async () => {
  const scopes = (await coloured('poi "a" //[1, 2, 0, 0, 0, 0, 1]')).map(([, scope]) => scope);
  assert.strictEqual(scopes[2], "comment.line.pose.pursue");
});

test("every piece of every scenario has a colour", async () => {
  const folder = process.env.PURSUE_SCENARIOS || path.join(__dirname, "..", "..", "..", "scenarios");
  const files = fs.readdirSync(folder, { recursive: true }).filter((file) => file.endsWith(".pur"));
  assert.ok(files.length > 0);
  for (const file of files) {
    for (const [word, scope] of await coloured(fs.readFileSync(path.join(folder, file), "utf8"))) {
      assert.notStrictEqual(scope, "source.pursue", `${file}: ${word}`);
    }
  }
});
