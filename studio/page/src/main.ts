// Pinhole Studio's page: the text on one side, its picture on the other, and either of them changes
// the other. This file puts the parts together.

import { session, takeToken } from "./address";
import { redo, redoDepth, undo, undoDepth } from "@codemirror/commands";
import { keymap, type ViewUpdate } from "@codemirror/view";
import { connection } from "./connection";
import { changesDiagnostics, fixKey, publishDiagnostics, showProblems } from "./diagnostics";
import { byId } from "./dom";
import { draftChanged, keepDraft, offerDrafts } from "./drafts";
import { editor } from "./editor";
import { files, sceneHistory } from "./files";
import { frames } from "./frames";
import { hoverAgain } from "./hover";
import { hintField, openSwatch, refreshHints } from "./hints";
import "./layout";
import { numberControls } from "./numbers";
import { listObjects, refreshOutlines } from "./outlines";
import { overlays } from "./overlays";
import { picture } from "./picture";
import { feedProjectors, isProjector, project } from "./projector";
import "./pointers";
import type { HostedFile } from "./protocol";
import { selection } from "./selection";
import { offerSharing, sceneInAddress, showProgress } from "./share";
import { mapSliders, refreshSliders } from "./sliders";
import * as status from "./status";
import { setText } from "./visible";

/** How long the text has to rest before hints, sliders and objects are asked for, in ms. */
const REST = 150;

editor.extend([keymap.of([fixKey, { key: "Alt-Enter", run: openSwatch }]), numberControls,
  hintField, sceneHistory]);
editor.onUpdate = update => {
  if (update.docChanged) {
    selection.mapped(update.changes);
    mapSliders(update.changes);
    files.follow(update.transactions);
  }
  if (update.selectionSet) selection.cursorMoved();
  if (update.docChanged) changed();
  if (changesDiagnostics(update)) showProblems();
  showUndo(update);
};
editor.diagnosed = published => void publishDiagnostics(published);
frames.onShow = shown => {
  status.picture(shown.size, shown.fineness);
  feedProjectors(shown);
  picture.show(shown);
};
frames.onState = state => {
  if (state === "good") status.stale(null);
  else if (state === "broken") status.stale(picture.isEmpty
    ? "The text has errors, so there is no picture yet."
    : "The text has errors. This is its last good picture.");
  else status.stale(`No picture of the newest text: ${state.message}`);
};
frames.onRest = rested;
files.onSaved = () => void keepDraft();

function changed(): void {
  if (editor.uri === "") return;
  frames.changed();
  // The coarse picture comes first.
  void frames.coarse.then(() => refreshOutlines());
  files.show();
  // Nobody looks at these while a hand moves.
  if (frames.dragging === null) rested();
  status.changed();
}

let resting: ReturnType<typeof setTimeout>;

/** What a text at rest has comes a little later. */
function rested(): void {
  draftChanged();
  clearTimeout(resting);
  resting = setTimeout(() => {
    if (editor.uri === "") return;
    hoverAgain();
    void refreshHints();
    void refreshSliders();
    void listObjects();
  }, REST);
}

/** Undo and Redo are offered where there is something. */
function showUndo({ state }: ViewUpdate): void {
  byId<HTMLButtonElement>("undo").disabled = undoDepth(state) === 0;
  byId<HTMLButtonElement>("redo").disabled = redoDepth(state) === 0;
}

overlays.onNeed = selection.onChange = () => void refreshOutlines();
picture.onView = () => {
  overlays.draw();
  selection.draw();
};

connection.onHang = isHanging => status.connection(isHanging ? "hanging" : "open", true);
let isConnected = false;
connection.onState = state => {
  status.connection(state, editor.uri !== "");
  if (state === "open") {
    editor.connected();
    changed();
  } else if (isConnected) editor.disconnected();
  isConnected = state === "open";
};

const linked = sceneInAddress();
connection.onNotification = async (method, params) => {
  if (method === "studio/progress") showProgress((params as { share: number }).share);
  if (method !== "studio/file") return;
  const text = await linked;
  const first = editor.uri === "";
  files.hosted(params as HostedFile, text);
  if (!first) return;
  changed();
  void offerDrafts((params as HostedFile).draft ?? null);
};

addEventListener("hashchange", async () => {
  const token = takeToken();
  if (token !== null && connection.state !== "open") {
    session.begin(token);
    connection.retry();
  }
  const text = await sceneInAddress();
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
// The editor has no more lines in the page than are seen.
addEventListener("beforeprint", () => {
  picture.fit();
  setText(byId("print-text"), `${files.name}, ${new Date().toLocaleString()}\n\n${editor.text}`);
});
offerSharing();
project();
if (!isProjector) connection.open();
