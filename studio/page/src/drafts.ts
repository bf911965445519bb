// Drafts: what is written and not saved, kept while one writes, and offered again after a reload, a
// crash, or a host that was lost. Each page has a key of its own, under which it writes over none
// of the others. The served host keeps drafts in a file; the static page in this browser.

import { createStore, del, delMany, set, values } from "idb-keyval";
import { connection, isServed } from "./connection";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { files } from "./files";
import { Refusal, type Draft } from "./protocol";
import { say } from "./status";

/** How long a text waits until it is kept, in milliseconds, however fast one types. */
const BEHIND = 500;
/** So many drafts are in the browser. */
const MOST = 10;
/** So many are offered at once. */
const OFFERED = 3;

const store = isServed ? undefined : createStore("pinhole-drafts", "drafts");

let timer = 0;
const freshId = () => `${Date.now()} ${Math.random()}`;
let id = freshId();
/** Whether something is kept under this key. */
let isKept = false;
/** What is to be kept under which key, or forgotten for null, as soon as that can be done. */
const due = new Map<string, Draft | null>();
/** What is offered and not answered yet, the newest first. */
let offers: Draft[] = [];
const bar = byId("draft-bar");

byId("draft-later").addEventListener("click", () => (bar.hidden = true));
addEventListener("pagehide", () => void keepDraft());
files.onLeave = leave;
files.onSaved = text => void keepDraft(text);

/** The text has changed. */
export function draftChanged(): void { timer ||= setTimeout(() => void keepDraft(), BEHIND); }

/** The text is what there is to keep, if it is not saved. What is saved, or there, is no offer. */
async function keepDraft(saved?: string): Promise<void> {
  clearTimeout(timer);
  timer = 0;
  const { isUnsaved, textToSave } = files;
  if (isUnsaved || isKept) due.set(id, isUnsaved ? newDraft() : null);
  isKept = isUnsaved;
  for (const it of offers) if (it.text === saved || it.text === textToSave) forget(it);
  await Promise.all([...due].map(async ([id, draft]) => {
    try {
      await stored(id, draft);
      if (due.get(id) === draft) due.delete(id);
    } catch (error) {
      // Without a connection the text is kept when there is one.
      if (error instanceof Refusal) say(`No draft is kept: ${error.message}`, "warning");
    }
  }));
}

function newDraft(): Draft {
  const { textToSave: text, at: { base, name } } = files;
  return { id, name, text, base, time: Math.floor(Date.now() / 1000) };
}

/** Offers what other pages have kept. */
export async function offerDrafts(kept: Draft[] | undefined): Promise<void> {
  offers = kept ?? (isServed ? [] : await all().catch(() => []));
  show();
  await keepDraft();
}

function show(): void {
  bar.hidden = offers.length === 0;
  byId("draft-choices").replaceChildren(...offers.slice(0, OFFERED).map(draft => {
    const time = new Date(draft.time * 1000)
      .toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
    const other = isServed && draft.base !== files.at.seen
      ? " The file holds something else; Save will ask." : "";
    const { length } = draft.text.split("\n");
    const row = create("li", "", `${draft.name}, of ${time}, ${length} lines.${other}`);
    row.append(createButton("Restore", "primary", () => answer(draft, true)),
      createButton("Forget", "", () => answer(draft, false)));
    return row;
  }));
}

function answer(draft: Draft, isRestored: boolean): void {
  if (isRestored) {
    leave();
    files.restore(draft);
  }
  forget(draft);
  void keepDraft();
  editor.view.focus();
}

function forget(draft: Draft): void {
  due.set(draft.id, null);
  offers = offers.filter(it => it !== draft);
  show();
}

/** Something else comes in the place of what is written, which is offered in its turn, or
 *  forgotten under its own key if it has just been undone. */
function leave(): void {
  if (!files.isUnsaved) return void keepDraft();
  const left = newDraft();
  due.set(id, left);
  offers.unshift(left);
  id = freshId();
  isKept = false;
  show();
}

const all = async () => (await values<Draft>(store)).sort((a, b) => b.time - a.time);

/** Keeps a draft under its key, or forgets what is kept there. */
async function stored(id: string, draft: Draft | null): Promise<void> {
  if (isServed) return connection.request("studio/draft", draft ?? { id, text: null });
  if (draft === null) return del(id, store);
  await set(id, draft, store);
  await delMany((await all()).slice(MOST).map(({ id }) => id), store);
}
