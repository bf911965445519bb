// Pinhole Studio's page: the text on one side, its picture on the other, and either of them changes
// the other. This file puts the parts together.

import { session, takeToken } from "./address";
import { redo, redoDepth, undo, undoDepth } from "@codemirror/commands";
import { keymap, type ViewUpdate } from "@codemirror/view";
import { Connection, webSocket, worker } from "./connection";
import { changesDiagnostics, fixKey, Problems, publishDiagnostics } from "./diagnostics";
import { byId } from "./dom";
import { Drafts } from "./drafts";
import { SceneEditor } from "./editor";
import { Files } from "./files";
import { Frames } from "./frames";
import { Hover } from "./hover";
import { hintField, Hints, openSwatch } from "./hints";
import { Keys } from "./keys";
import { layOut, offerLayers } from "./layout";
import { numberControls } from "./numbers";
import { Outlines } from "./outlines";
import { OverlayLayer } from "./overlays";
import { Picture } from "./picture";
import { Pointers } from "./pointers";
import type { HostedFile, Limits } from "./protocol";
import { Selection } from "./selection";
import { offerSharing, sceneInAddress, showProgress } from "./share";
import { Status } from "./status";
import { followTheme, themeExtension } from "./theme";
import { Tools } from "./tools";
import { setText } from "./visible";

const meta = (name: string) => document.querySelector<HTMLMetaElement>(
  `meta[name="pinhole-${name}"]`)?.content;
const isServed = meta("host") !== "static";
const connection = new Connection(isServed ? webSocket("/socket") : worker("engine.js"));
const status = new Status();
const picture = new Picture(byId("stage"), document.querySelector("canvas") as HTMLCanvasElement);
const overlays = new OverlayLayer(document.querySelector("#lines") as SVGSVGElement, picture);

const limitsAt = (at: number) =>
  editor.ask<Limits>("pinhole/limits", { position: editor.position(at) });
const editor: SceneEditor = new SceneEditor(
  byId("editor"), connection, meta("nonce"),
  [keymap.of([fixKey, { key: "Alt-Enter", run: openSwatch }]), numberControls(limitsAt), hintField,
    themeExtension()],
  update => {
    if (update.docChanged) selection.mapped(update.changes);
    if (update.selectionSet) selection.cursorMoved();
    if (update.docChanged) changed();
    if (changesDiagnostics(update)) problems.update();
    showUndo(update);
  },
);
editor.diagnosed = published => void publishDiagnostics(editor, published);
const problems = new Problems(() => editor.view);
const hints = new Hints(editor);
const frames = new Frames(editor, connection,
  shown => {
    status.picture(shown.size, shown.fineness);
    picture.show(shown);
  },
  state => {
    if (state === "good") status.stale(null);
    else if (state === "broken") status.stale(picture.isEmpty
      ? "The text has errors, so there is no picture yet."
      : "The text has errors. This is its last good picture.");
    else status.stale(`No picture of the newest text: ${state.message}`);
  },
);
const selection = new Selection(editor, picture, overlays);
const outlines = new Outlines(editor, connection, frames, overlays, selection);
const tools = new Tools(picture.stage, status);
const bench = {
  editor, frames, picture, along: () => tools.along, rested: () => {
    void outlines.rested();
    rested();
  },
};
new Pointers(bench, selection, tools, new Keys(bench, selection, tools, status));
const hover = new Hover(editor, picture, overlays, status);
outlines.onRest = () => hover.again();
const files = new Files(editor, connection, status, isServed);
const drafts = new Drafts(editor, connection, files, isServed);
files.onSaved = () => void drafts.keep();

function changed(): void {
  if (editor.uri === "") return;
  frames.changed();
  outlines.changed();
  files.show();
  // Nobody looks at these while a hand moves.
  if (frames.dragging === null) rested();
  status.changed();
}

function rested(): void {
  hints.changed();
  drafts.changed();
}

/** Undo and Redo are offered where there is something. */
function showUndo({ state }: ViewUpdate): void {
  byId<HTMLButtonElement>("undo").disabled = undoDepth(state) === 0;
  byId<HTMLButtonElement>("redo").disabled = redoDepth(state) === 0;
}

overlays.onNeed = selection.onChange = () => void outlines.refresh();
picture.onView = () => {
  overlays.draw();
  selection.draw();
};

connection.onHang = isHanging => status.hanging(isHanging);
let isConnected = false;
connection.onState = state => {
  status.connection(state, editor.uri !== "");
  if (state === "open") {
    editor.connected();
    changed();
  } else if (isConnected) editor.disconnected();
  isConnected = state === "open";
};

const linked = sceneInAddress(status);
connection.onNotification = async (method, params) => {
  if (method === "studio/progress") showProgress((params as { share: number }).share);
  if (method !== "studio/file") return;
  const text = await linked;
  const first = editor.uri === "";
  files.hosted(params as HostedFile, text);
  if (!first) return;
  changed();
  void drafts.offer((params as HostedFile).draft ?? null);
};

addEventListener("hashchange", async () => {
  const token = takeToken();
  if (token !== null && connection.state !== "open") {
    session.begin(token);
    connection.retry();
  }
  const text = await sceneInAddress(status);
  if (text !== null) editor.replace(text);
});
byId("undo").addEventListener("click", () => undo(editor.view));
byId("redo").addEventListener("click", () => redo(editor.view));
document.addEventListener("keydown", event => {
  const key = event.key.toLowerCase();
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const isElsewhere = !editor.view.hasFocus
    && !(event.target instanceof HTMLInputElement && event.target.type === "text");
  if (key === "s") void files.save();
  else if (isElsewhere && key === "z") (event.shiftKey ? redo : undo)(editor.view);
  else if (isElsewhere && key === "y") redo(editor.view);
  else return;
  event.preventDefault();
});
followTheme(editor.view);
// The editor has no more lines in the page than are seen.
addEventListener("beforeprint", () => {
  picture.fit();
  setText(byId("print-text"), `${files.name}, ${new Date().toLocaleString()}\n\n${editor.text}`);
});
layOut(picture);
offerLayers(overlays);
offerSharing(editor, connection, status, files);
connection.open();
