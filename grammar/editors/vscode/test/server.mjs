// Runs the language server as an editor does.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";

const require = createRequire(import.meta.url);
const { createProtocolConnection, StreamMessageReader, StreamMessageWriter } = require("vscode-languageserver-protocol/node");

/** The program: the environment variable PINHOLE or, by default, `pinhole` on the path. */
export const program = process.env.PINHOLE ?? "pinhole";

// The server gets its own cache folder, so that tests do not change the user's caches.
const caches = mkdtempSync(path.join(tmpdir(), "pinhole-caches-"));
process.env.XDG_CACHE_HOME = caches;
process.on("exit", () => rmSync(caches, { recursive: true, force: true }));

/** Starts a server. Returns its capabilities, and functions that send requests, open a text, and
 * stop the server. */
export async function start() {
  const server = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const exit = new Promise((resolve, reject) => server.on("error", reject).on("exit", resolve));
  const connection = createProtocolConnection(new StreamMessageReader(server.stdout), new StreamMessageWriter(server.stdin));
  const waiting = new Map();
  connection.onNotification("textDocument/publishDiagnostics", ({ uri, diagnostics }) => waiting.get(uri)?.(diagnostics));
  connection.listen();
  const ask = (method, params) => connection.sendRequest(method, params);
  const started = ask("initialize", {
    processId: process.pid,
    rootUri: null,
    capabilities: {
      general: { positionEncodings: ["utf-16"] },
      textDocument: {
        completion: { completionItem: { snippetSupport: true, documentationFormat: ["markdown"] } },
        hover: { contentFormat: ["markdown"] },
        codeAction: { codeActionLiteralSupport: { codeActionKind: { valueSet: ["quickfix"] } } },
        semanticTokens: { requests: { full: true }, formats: ["relative"], tokenTypes: [], tokenModifiers: [] },
      },
    },
  });
  const { capabilities } = await Promise.race([started, exit.then(status => { throw new Error(`pinhole lsp ended with status ${status}`); })]);
  await connection.sendNotification("initialized", {});
  return {
    capabilities,
    ask,
    /** Opens a text, and returns its diagnostics. */
    async open(uri, text) {
      const diagnostics = new Promise(resolve => waiting.set(uri, resolve));
      await connection.sendNotification("textDocument/didOpen", { textDocument: { uri, languageId: "pinhole", version: 1, text } });
      return diagnostics;
    },
    /** Ends the server, and returns its exit status. */
    async stop() {
      await ask("shutdown");
      await connection.sendNotification("exit");
      const status = await exit;
      connection.dispose();
      return status;
    },
  };
}

/**
 * Returns the words of an open text with the types of the server's semantic tokens, in the form of
 * `scoped`.
 */
export async function classified({ ask, capabilities }, uri, source) {
  const { tokenTypes, tokenModifiers } = capabilities.semanticTokensProvider.legend;
  const lines = source.split(/\r?\n/);
  const { data } = await ask("textDocument/semanticTokens/full", { textDocument: { uri } });
  const words = [];
  let [line, start] = [0, 0];
  for (let i = 0; i < data.length; i += 5) {
    start = data[i] === 0 ? start + data[i + 1] : data[i + 1];
    line += data[i];
    const modifiers = tokenModifiers.filter((_, bit) => data[i + 4] & (1 << bit));
    const type = [tokenTypes[data[i + 3]], ...modifiers].join(".");
    words.push({ line, start, text: lines[line].slice(start, start + data[i + 2]), type });
  }
  return words;
}
