// The extension: finds the program, keeps its language server running, and shows and renders
// pictures.

const { execFile } = require("node:child_process");
const path = require("node:path");
const vscode = require("vscode");
const { ErrorAction, LanguageClient } = require("vscode-languageclient/node");
const { findBinary } = require("./binary");
const { Pictures, isOfPage } = require("./panel");

/** Folder of the extension; its subfolder `bin` may contain the program. */
let home;

/** The client of the server, while it runs. */
let client;

/** The panel with the picture beside the text. */
let pictures;

/**
 * Promise that settles when all starts and stops so far have finished. They run one after another,
 * so that two quick changes of a setting do not leave two servers.
 */
let turn = Promise.resolve();

function activate(context) {
  home = context.extensionPath;
  pictures = new Pictures(context);
  context.subscriptions.push(
    vscode.commands.registerCommand("pinhole.render", render),
    vscode.commands.registerCommand("pinhole.watch", watch),
    vscode.commands.registerCommand("pinhole.restart", () => next(restart)),
    vscode.commands.registerCommand("pinhole.use", use),
    vscode.workspace.onDidChangeConfiguration(change => {
      if (change.affectsConfiguration("pinhole.path")) next(restart);
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => next(restart)),
  );
  return next(start);
}

function deactivate() {
  return next(stop);
}

function next(step) {
  turn = turn.then(step).catch(error => void vscode.window.showErrorMessage(`Pinhole: ${error.message ?? error}`));
  return turn;
}

async function start() {
  const command = binary();
  if (command === undefined) return;
  const started = new LanguageClient(
    "pinhole",
    "Pinhole",
    { command, args: ["lsp"] },
    {
      documentSelector: [{ language: "pinhole", scheme: "file" }, { language: "pinhole", scheme: "untitled" }],
      // The panel's page has texts of its own at the server, which are not files of the editor.
      middleware: { handleDiagnostics: (uri, diagnostics, next) => isOfPage(uri) || next(uri, diagnostics) },
      errorHandler: {
        // A message to a server that has just crashed fails. By default, the client would then
        // stop, and would not start the server again when the connection is closed a moment later.
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => restarts.closed(),
      },
    },
  );
  // Starts a server again unless it crashed five times within three minutes.
  const restarts = started.createDefaultErrorHandler();
  client = started;
  pictures.serve(client);
  // The client itself shows the error, so it is ignored here.
  await client.start().catch(() => {});
}

async function stop() {
  const running = client;
  client = undefined;
  if (running?.needsStop()) await running.stop();
}

async function restart() {
  await stop();
  await start();
}

/** Returns the path of the program. If it is not found, tells the user and returns undefined. */
function binary() {
  const setting = vscode.workspace.getConfiguration("pinhole").get("path", "");
  const found = findBinary(setting, vscode.workspace.workspaceFolders?.[0]?.uri.fsPath, home);
  if (found === undefined) {
    const where = setting.trim() === "" ? "neither on PATH nor where cargo installs programs (~/.cargo/bin)" : `not at ${setting}, where the setting pinhole.path says`;
    const message = `The program pinhole is ${where}. Without it, scenes are highlighted, and no more.`;
    vscode.window.showErrorMessage(message, "Choose File…", "How to Get It").then(answer => {
      if (answer === "Choose File…") return chooseBinary();
      // The extension's own page explains how to install the program.
      if (answer === "How to Get It") return vscode.commands.executeCommand("extension.open", "pinhole.pinhole");
    });
  }
  return found;
}

/**
 * Sets the path of the program to a file that the user chooses. The change of this setting restarts
 * the server.
 */
async function chooseBinary() {
  const [file] = (await vscode.window.showOpenDialog({ title: "The program pinhole", openLabel: "Use" })) ?? [];
  if (file === undefined) return;
  const configuration = vscode.workspace.getConfiguration("pinhole");
  // If the workspace has this setting, it is changed there, because it overrides the global one.
  const { workspaceValue } = configuration.inspect?.("path") ?? {};
  const { Global, Workspace } = vscode.ConfigurationTarget;
  await configuration.update("path", file.fsPath, workspaceValue === undefined ? Global : Workspace);
}

/**
 * Treats the open file as a scene if another extension has claimed its ending, and offers to do so
 * for every file with this ending. The server runs already, since the command activates the
 * extension.
 */
async function use() {
  const document = vscode.window.activeTextEditor?.document;
  if (document === undefined) return;
  await vscode.languages.setTextDocumentLanguage(document, "pinhole");
  const ending = path.extname(document.uri.path);
  if (ending === "") return;
  const every = `Every *${ending}`;
  const answer = await vscode.window.showInformationMessage("This file is a Pinhole scene until it is closed.", every);
  if (answer !== every) return;
  const files = vscode.workspace.getConfiguration("files");
  const associations = { ...files.inspect("associations")?.globalValue, [`*${ending}`]: "pinhole" };
  await files.update("associations", associations, vscode.ConfigurationTarget.Global);
}

/** Saves the scene in the editor and returns its path. If it has none, tells the user why. */
async function savedScene() {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "pinhole") {
    vscode.window.showInformationMessage("Open a scene to render it. If another extension has its ending, run “Pinhole: Use Pinhole for This File” first.");
    return undefined;
  }
  // A scene is not rendered if it has no file or if the user chose not to save it.
  if (document.uri.scheme !== "file" || (document.isDirty && !(await document.save()))) {
    vscode.window.showInformationMessage("Save the scene to render it: the picture is written beside it.");
    return undefined;
  }
  return document.uri.fsPath;
}

const pictureOf = scene => path.format({ ...path.parse(scene), base: undefined, ext: ".png" });

const openBeside = picture =>
  vscode.commands.executeCommand("vscode.open", vscode.Uri.file(picture), {
    viewColumn: vscode.ViewColumn.Beside,
    preserveFocus: true,
  });

/** Renders the scene to the PNG beside it, and shows the picture. */
async function render() {
  const [command, scene] = [binary(), await savedScene()];
  if (command === undefined || scene === undefined) return;
  const picture = pictureOf(scene);
  const options = { location: vscode.ProgressLocation.Notification, title: `Rendering ${path.basename(scene)}`, cancellable: true };
  const problem = await vscode.window.withProgress(options, (_, cancellation) => run(command, ["render", scene, "-o", picture], cancellation));
  if (problem === undefined) await openBeside(picture);
  else if (problem !== "") vscode.window.showErrorMessage(problem);
}

/** Runs the program. Returns undefined on success, "" if the user cancelled, or its messages. */
function run(command, args, cancellation) {
  return new Promise(resolve => {
    let cancelled = false;
    const env = { ...process.env, NO_COLOR: "1" };
    const child = execFile(command, args, { cwd: path.dirname(args[1]), env }, (error, _, said) => {
      resolve(cancelled ? "" : error === null ? undefined : summary(said) || error.message);
    });
    cancellation.onCancellationRequested(() => {
      cancelled = true;
      child.kill("SIGINT");
    });
  });
}

/** Returns only the first line of each problem in a report. The editor shows where the problems
 * are. */
function summary(said) {
  const heads = said.split("\n").filter(line => /^error\b/.test(line));
  return (heads.length > 0 ? heads : said.trim().split("\n")).map(line => line.replace(/^error(\[[\w:]+\])?: /, "")).join("\n");
}

/**
 * Renders the scene now and after every save, in a terminal. Shows the picture, which the editor
 * reloads when it changes.
 */
async function watch() {
  const [command, scene] = [binary(), await savedScene()];
  if (command === undefined || scene === undefined) return;
  const name = `Pinhole: ${path.basename(scene)}`;
  vscode.window.terminals.find(terminal => terminal.name === name)?.dispose();
  const terminal = vscode.window.createTerminal({ name, shellPath: command, shellArgs: ["watch", scene], cwd: path.dirname(scene) });
  terminal.show(true);
  const picture = pictureOf(scene);
  await appears(picture);
  await openBeside(picture);
}

/** Waits until the file exists, for a few seconds at most. */
async function appears(file) {
  for (let tries = 0; tries < 50; tries++) {
    const isThere = await vscode.workspace.fs.stat(vscode.Uri.file(file)).then(() => true, () => false);
    if (isThere) return;
    await new Promise(resolve => setTimeout(resolve, 200));
  }
}

module.exports = { activate, deactivate };
