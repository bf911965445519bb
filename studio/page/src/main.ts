// The page of Pinhole Studio: a text and its picture. This module connects all other modules.

import { session, takeToken } from "./address";
import { redo, redoDepth, undo, undoDepth } from "@codemirror/commands";
import { keymap } from "@codemirror/view";
import type { Position } from "vscode-languageserver-protocol";
import { connection } from "./connection";
import { firstError, fixKey, problemsFollow, publishDiagnostics } from "./diagnostics";
import { byId } from "./dom";
import { draftChanged, offerDrafts } from "./drafts";
import { editor } from "./editor";
import { files, sceneHistory } from "./files";
import { frames } from "./frames";
import { glass } from "./glass";
import { hoverAgain } from "./hover";
import { hintField, openSwatch, refreshHints } from "./hints";
import "./layout";
import { followAddress, lessonChanged, lessonOnPaper, startLessons } from "./lessons";
import { numberControls } from "./numbers";
import { listObjects, refreshOutlines } from "./outlines";
import { outside } from "./outside";
import { overlays } from "./overlays";
import { panel } from "./panel";
import { picture } from "./picture";
import { feedProjectors, isProjector } from "./projector";
import "./pointers";
import type { HostedFile } from "./protocol";
import { selection } from "./selection";
import { sceneInAddress, showProgress } from "./share";
import { mapSliders, refreshSliders, stop } from "./sliders";
import * as status from "./status";
import { setText } from "./visible";

/** Delay after a change, in ms, before hints, sliders and objects are requested. It is longer than
 * the time between two keys in fast typing, so the requests are made in pauses. */
const REST = 150;

editor.extend([keymap.of([fixKey, { key: "Alt-Enter", run: openSwatch }]), numberControls,
  hintField, problemsFollow, sceneHistory]);
editor.onUpdate = update => {
  if (update.docChanged) {
    files.follow(update.transactions);
    changed();
    selection.mapped(update.changes);
    mapSliders(update.changes);
  }
  if (update.selectionSet) {
    selection.cursorMoved();
    const position = editor.position(update.state.selection.main.head);
    if (panel && !isFollowing) connection.notify("panel/cursor", { position });
  }
  byId<HTMLButtonElement>("undo").disabled = undoDepth(update.state) === 0;
  byId<HTMLButtonElement>("redo").disabled = redoDepth(update.state) === 0;
};
frames.onShow = shown => {
  status.picture(shown.size, shown.fineness);
  feedProjectors(shown);
  picture.show(shown);
};
frames.onState = state => {
  if (state === "good") status.markOutdated(null);
  else if (state === "broken") status.markOutdated(picture.isEmpty
    ? "The text has errors, so there is no picture yet."
    : "The text has errors. This is its last good picture.");
  else status.markOutdated(`No picture of the newest text: ${state.message}`);
};
frames.onRest = () => {
  rested();
  lessonChanged();
  outside.changed();
  if (waiting !== null) void hosted(waiting);
};

function changed(): void {
  if (connection.state !== "open") {
    const hasText = editor.text !== "";
    status.connection(connection.state, hasText);
    const isUpToDate = !hasText || frames.shown?.doc?.eq(editor.view.state.doc);
    status.markOutdated(isUpToDate ? null : picture.isEmpty
      ? "Without a connection there is no picture."
      : "Without a connection this is the picture of an older text.");
  }
  if (editor.uri === "") return;
  frames.changed();
  void refreshOutlines();
  outside.changed();
  files.show();
  draftChanged();
  lessonChanged();
  // Hints, sliders and objects are not updated during a drag.
  if (frames.dragging === null) rested();
  // Hints of an older text are hidden until new ones have arrived.
  else byId("editor").dataset["outdated"] = "";
  status.changed();
}

let resting: ReturnType<typeof setTimeout>;

/** Requests hints, sliders and objects after a delay without changes. */
function rested(): void {
  clearTimeout(resting);
  resting = setTimeout(() => {
    hoverAgain();
    glass.changed();
    // In a panel, the page's text is hidden.
    if (!panel) void refreshHints().then(() => delete byId("editor").dataset["outdated"]);
    if (!panel) void refreshSliders();
    void listObjects();
  }, REST);
}

overlays.onNeed = selection.onChange = () => {
  void refreshOutlines();
  void outside.refresh();
};
picture.onView = () => {
  overlays.draw();
  selection.draw();
};

connection.onHang = isHanging => status.connection(isHanging ? "hanging" : "open", true);
connection.onState = state => {
  status.connection(state, false);
  if (state === "open") editor.connected();
  else editor.client.disconnect();
  if (state !== "open" && !files.hasHostFile) void offerDrafts();
  changed();
};

async function openLink(): Promise<void> {
  const text = await sceneInAddress();
  if (text !== null) files.restore(text);
}

const linked = openLink();
editor.onNotification = (method, params) => {
  if (method === "textDocument/publishDiagnostics") void publishDiagnostics(params);
  if (method === "studio/progress") showProgress(params.share);
  if (method === "studio/file") void hosted(params);
  if (method === "panel/text" || method === "panel/cursor") follow(params);
};

/** Whether the page is applying a message from VS Code's editor. The cursor movements that this
 * causes are not reported back to VS Code. */
let isFollowing = false;

/** Copies the text or the cursor of VS Code's editor into the page. */
function follow({ text, position }: { text?: string; position?: Position }): void {
  isFollowing = true;
  if (position) editor.view.dispatch({ selection: { anchor: editor.offset(position) } });
  if (text !== undefined) {
    const isFirst = editor.uri === "";
    editor.replace(text);
    editor.start();
    if (isFirst) changed();
    connection.notify("panel/followed", {});
  }
  isFollowing = false;
}

/** File that the host has sent during a drag. It is handled when the drag ends. */
let waiting: HostedFile | null = null;

async function hosted(file: HostedFile): Promise<void> {
  await linked;
  const first = !files.hasHostFile;
  // If new content of the host's file arrives during a drag, it is handled when the drag ends. A
  // playing slider also sets `frames.dragging`, possibly for a long time. It is stopped, so that
  // the new content need not wait for it.
  stop();
  waiting = frames.dragging === null ? null : file;
  if (waiting !== null) return;
  files.hosted(file);
  if (!first) return;
  changed();
  startLessons(file.lesson, !file.saved);
  void offerDrafts(file.drafts);
}

addEventListener("hashchange", async () => {
  const token = takeToken();
  if (token !== null && connection.state !== "open") {
    session.keep(token, "address");
    connection.retry();
  }
  await openLink();
  overlays.showAddressed();
  if (files.hasHostFile) followAddress();
});
byId("undo").addEventListener("click", () => undo(editor.view));
byId("redo").addEventListener("click", () => redo(editor.view));
const place = () => [picture, outside.picture].forEach(it => it.fit());
addEventListener("beforeprint", () => {
  // On paper, the pictures have other sizes, so they are fitted again before the page is printed.
  document.body.classList.add("paper");
  byId("dock").classList.toggle("without-room", byId("dock").clientWidth === 0);
  place();
  // The editor creates elements only for visible lines, so printing needs a copy of the text.
  setText(byId("print-text"), [`${files.current.name}, ${new Date().toLocaleString()}`,
    ...firstError(), "", editor.text].join("\n"));
  byId("print-lesson").replaceChildren(...lessonOnPaper());
});
addEventListener("afterprint", () => {
  document.body.classList.remove("paper");
  requestAnimationFrame(place); // until then, the page is laid out as paper
});
if (!isProjector) connection.open();
