// Starts `pursue-gen lsp` for scenarios, and shows the map of the one that is being written.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

const PAUSE = 400; // milliseconds without typing before the map is drawn again

/** @type {LanguageClient | undefined} */
let client;

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("pursue.showMap", () => showMap(context)),
    vscode.commands.registerCommand("pursue.restart", restart),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("pursue")) restart();
    }),
  );
  await start();
}

async function deactivate() {
  const old = client;
  client = undefined;
  if (old && old.isRunning()) await old.stop();
}

async function restart() {
  await deactivate();
  await start();
}

async function start() {
  const settings = vscode.workspace.getConfiguration("pursue");
  const [command, ...args] = settings.get("command");
  const docs = settings.get("docs");
  client = new LanguageClient(
    "pursue",
    "PuRSUE-ML",
    { command, args },
    { documentSelector: [{ language: "pursue" }], initializationOptions: docs ? { docs } : {} },
  );
  try {
    await client.start();
  } catch (problem) {
    client = undefined;
    const choice = await vscode.window.showErrorMessage(
      `PuRSUE-ML: could not start "${[command, ...args].join(" ")}". Install it with ` +
        `pip install "pursue-gen[lsp]", or say in the settings where it is.`,
      "Open settings",
    );
    if (choice) vscode.commands.executeCommand("workbench.action.openSettings", "pursue.command");
  }
}

/** Shows the map of the scenario in the active editor beside it, and keeps it up to date. */
function showMap(context) {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "pursue") {
    vscode.window.showInformationMessage("PuRSUE-ML: open a scenario (*.pur) first.");
    return;
  }
  const document = editor.document;
  const name = document.uri.path.split("/").pop();
  const panel = vscode.window.createWebviewPanel(
    "pursue.map",
    `Map of ${name}`,
    { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
    { enableScripts: false, localResourceRoots: [] },
  );
  let timer;
  const draw = async () => {
    const answer = await asked(document.uri.toString());
    panel.webview.html = page(answer);
  };
  const listener = vscode.workspace.onDidChangeTextDocument((change) => {
    if (change.document.uri.toString() !== document.uri.toString()) return;
    clearTimeout(timer);
    timer = setTimeout(draw, PAUSE);
  });
  panel.onDidDispose(() => {
    clearTimeout(timer);
    listener.dispose();
  });
  context.subscriptions.push(panel);
  draw();
}

async function asked(uri) {
  if (!client || !client.isRunning()) return { message: "the language server is not running" };
  try {
    return await client.sendRequest("pursue/map", { uri });
  } catch (problem) {
    return { message: String(problem.message || problem) };
  }
}

/** The page that holds the picture; it can neither run scripts nor load anything. */
function page(answer) {
  const shown = answer.svg || `<p>No map yet: ${escaped(answer.message || "")}.</p>`;
  const policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";
  return (
    `<!DOCTYPE html><html><head><meta charset="utf-8">` +
    `<meta http-equiv="Content-Security-Policy" content="${policy}">` +
    `<style>body{padding:8px}svg{max-width:100%;height:auto;background:#fff}</style></head>` +
    `<body>${shown}</body></html>`
  );
}

function escaped(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

module.exports = { activate, deactivate, page };
