// Drafts: unsaved texts, stored while the user types. They are offered again after a reload, a
// crash or the end of the host. Each page stores its draft under its own key. If there is a host,
// the draft is sent to it; the browser's copy is deleted when the host has stored the draft.

import { createStore, del, delMany, set, values } from "idb-keyval";
import { connection, isServed } from "./connection";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { files } from "./files";
import { Refusal, type Draft } from "./protocol";
import { say } from "./status";
import { setText } from "./visible";

/** Delay before a changed text is stored, in ms. A crash can lose what was typed during this time;
 * with a shorter delay, the text would be sent more often. */
const BEHIND = 500;
/** Maximum number of drafts in the browser. If there are more, the oldest are deleted. Each open
 * page stores one draft, and users rarely have more than a few pages open. */
const MOST = 10;
/** Maximum number of drafts offered at once, since each needs a row of the page. When the user has
 * restored or discarded one, the next is offered. */
const OFFERED = 3;

const store = createStore("pinhole-drafts", "drafts");

let timer = 0;
const freshId = () => `${Date.now()} ${Math.random()}`;
let id = freshId();
/** Whether a draft is stored under the key of this page. */
let isKept = false;
/** Drafts that are not stored yet, by key. The host stores them or, if there is no host, the
 * browser. Null stands for a draft that must be deleted. */
const due = new Map<string, Draft | null>();
/** Last draft that the user has restored; null if there is none. Its stored copy is kept until its
 * text is saved to the file, since Undo can remove the text from the editor. */
let restored: Draft | null = null;
/** Drafts that were offered and neither restored nor discarded yet, the newest first. */
let offers: Draft[] = [];
const bar = byId("draft-bar");
const kept = byId("connection-kept");
setText(byId("kept-port"), location.port);

byId("draft-later").addEventListener("click", () => (bar.hidden = true));
for (const type of ["beforeunload", "pagehide"]) addEventListener(type, () => void keepDraft());
files.onLeave = leave;
files.onSaved = text => void keepDraft(text);

/** Stores the changed text after a delay. */
export function draftChanged(): void { timer ||= setTimeout(() => void keepDraft(), BEHIND); }

/** Stores the text if it is unsaved. Deletes offered drafts equal to this text or to `saved`. */
async function keepDraft(saved?: string): Promise<void> {
  clearTimeout(timer);
  timer = 0;
  const { isUnsaved, textToSave } = files;
  if (saved !== undefined && restored !== null) due.set(restored.id, null);
  if (saved !== undefined) restored = null;
  const isNew = isUnsaved && textToSave !== restored?.text;
  if (isNew || isKept) due.set(id, isNew ? newDraft() : id === restored?.id ? restored : null);
  isKept = isNew;
  // Offered drafts are deleted if their text is saved or in the editor. The text in the editor is
  // compared only after the server has opened the scene; before, it may still be replaced.
  forgetEqual(saved);
  if (editor.uri !== "") forgetEqual(textToSave);
  await Promise.all([...due].map(async ([id, draft]) => {
    try {
      await stored(id, draft);
      if (due.get(id) !== draft) return;
      due.delete(id);
      if (isServed) await del(id, store);
    } catch (error) {
      // Only a refusal is reported. If the connection is lost, the draft stays in `due` and is sent
      // later.
      if (error instanceof Refusal) say(`No draft is kept: ${error.message}`, "warning");
    }
  }));
}

function newDraft(): Draft {
  const { textToSave: text, current: { base, name } } = files;
  return { id, name, text, base, time: Math.floor(Date.now() / 1000) };
}

/** Offers the drafts of other pages. Drafts that the host has stored, `hosts`, are offered at once;
 * drafts in the browser are offered as soon as they are read. */
export async function offerDrafts(hosts: Draft[] = []): Promise<void> {
  offers = hosts;
  show();
  const here = await all().catch((): Draft[] => []);
  offers = [...here, ...offers.filter(it => here.every(({ id }) => id !== it.id))]
    .filter(it => it.id !== id);
  show();
  await keepDraft();
}

function show(): void {
  bar.hidden = offers.length === 0;
  byId("draft-choices").replaceChildren(...offers.slice(0, OFFERED).map(draft => {
    const time = new Date(draft.time * 1000)
      .toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
    const other = isServed && files.hasHostFile && draft.base !== files.current.seen
      ? " The file holds something else; Save will ask." : "";
    const { length } = draft.text.split("\n");
    const row = create("li", "", `${draft.name}, of ${time}, ${length} lines.${other}`);
    row.append(createButton("Restore", "primary", () => answer(draft, true)),
      createButton("Forget", "", () => answer(draft, false)));
    return row;
  }));
}

function answer(draft: Draft, isRestored: boolean): void {
  if (isRestored) files.closeLesson();
  if (isRestored) leave();
  forget(draft);
  if (isRestored) {
    due.delete(draft.id);
    restored = draft;
    // Before the host has sent its state, the page does not know whether the host has stored this
    // draft, too. Therefore, the page now stores its own drafts under the key of this draft. They
    // replace the host's copy if there is one.
    if (!files.hasHostFile) id = draft.id;
    files.restore(draft.text, draft.base, draft.name);
  }
  void keepDraft();
  editor.view.focus();
}

function forget(draft: Draft): void {
  due.set(draft.id, null);
  offers = offers.filter(it => it !== draft);
  show();
}

function forgetEqual(text?: string): void {
  for (const it of offers) if (it.text === text) forget(it);
}

/** Offers the unsaved text as a draft, because another scene is about to replace the text. */
function leave(): void {
  if (!files.isUnsaved) return void keepDraft();
  const left = files.textToSave === restored?.text ? restored : newDraft();
  forgetEqual(left.text); // the text may have been left before, for a lesson
  due.set(left.id, left);
  offers.unshift(left);
  id = freshId();
  isKept = false;
  show();
}

const all = async () => (await values<Draft>(store)).sort((a, b) => b.time - a.time);

/** Stores a draft under the key `id`. If `draft` is null, deletes the stored one. */
async function stored(id: string, draft: Draft | null): Promise<void> {
  // The draft is sent to the host before the browser has stored it, since the browser's storage may
  // fail or be slow.
  const here = storedHere(id, draft).catch(error => { if (!isServed) throw error; });
  await (isServed ? connection.request("studio/draft", draft ?? { id, text: null }) : here);
}

async function storedHere(id: string, draft: Draft | null): Promise<void> {
  if (draft === null) return del(id, store);
  await set(id, draft, store);
  kept.dataset["kept"] = "here";
  await delMany((await all()).slice(MOST).map(({ id }) => id), store);
}
