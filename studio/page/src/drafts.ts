// Drafts: what is written and not saved, kept while one writes, and offered again after a reload, a
// crash, or a host that was lost. Each page has a key of its own, or that of the draft that it goes
// on with without a host. This browser keeps them until the host has them, or where there is none.

import { createStore, del, delMany, set, values } from "idb-keyval";
import { connection, isServed } from "./connection";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { files } from "./files";
import { Refusal, type Draft } from "./protocol";
import { say } from "./status";
import { setText } from "./visible";

/** How long a text waits until it is kept, in milliseconds, however fast one types. */
const BEHIND = 500;
/** So many drafts are in the browser. */
const MOST = 10;
/** So many are offered at once. */
const OFFERED = 3;

const store = createStore("pinhole-drafts", "drafts");

let timer = 0;
const freshId = () => `${Date.now()} ${Math.random()}`;
let id = freshId();
/** Whether something is kept under this key. */
let isKept = false;
/** What is to be kept under which key, or forgotten for null, as soon as that can be done. */
const due = new Map<string, Draft | null>();
/** What was restored last: it is kept until it is saved, so that Undo does not lose it. */
let restored: Draft | null = null;
/** What is offered and not answered yet, the newest first. */
let offers: Draft[] = [];
const bar = byId("draft-bar");
const kept = byId("connection-kept");
setText(byId("kept-port"), location.port);

byId("draft-later").addEventListener("click", () => (bar.hidden = true));
for (const type of ["beforeunload", "pagehide"]) addEventListener(type, () => void keepDraft());
files.onLeave = leave;
files.onSaved = text => void keepDraft(text);

/** The text has changed. */
export function draftChanged(): void { timer ||= setTimeout(() => void keepDraft(), BEHIND); }

/** The text is what there is to keep, if it is not saved. What is saved, or there, is no offer. */
async function keepDraft(saved?: string): Promise<void> {
  clearTimeout(timer);
  timer = 0;
  const { isUnsaved, textToSave } = files;
  if (saved !== undefined && restored !== null) due.set(restored.id, null);
  if (saved !== undefined) restored = null;
  const isNew = isUnsaved && textToSave !== restored?.text;
  if (isNew || isKept) due.set(id, isNew ? newDraft() : id === restored?.id ? restored : null);
  isKept = isNew;
  // What is shown before there is a scene is still a draft.
  const there = [saved, editor.uri === "" ? undefined : textToSave];
  for (const it of offers) if (there.includes(it.text)) forget(it);
  await Promise.all([...due].map(async ([id, draft]) => {
    try {
      await stored(id, draft);
      if (due.get(id) !== draft) return;
      due.delete(id);
      if (isServed) await del(id, store);
    } catch (error) {
      // Without a connection the host gets it when there is one.
      if (error instanceof Refusal) say(`No draft is kept: ${error.message}`, "warning");
    }
  }));
}

function newDraft(): Draft {
  const { textToSave: text, at: { base, name } } = files;
  return { id, name, text, base, time: Math.floor(Date.now() / 1000) };
}

/** Offers what other pages have kept: here, which is newer, or with the host. */
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
    const other = isServed && files.isTold && draft.base !== files.at.seen
      ? " The file holds something else; Save will ask." : "";
    const { length } = draft.text.split("\n");
    const row = create("li", "", `${draft.name}, of ${time}, ${length} lines.${other}`);
    row.append(createButton("Restore", "primary", () => answer(draft, true)),
      createButton("Forget", "", () => answer(draft, false)));
    return row;
  }));
}

function answer(draft: Draft, isRestored: boolean): void {
  if (isRestored) leave();
  forget(draft);
  if (isRestored) {
    due.delete(draft.id);
    restored = draft;
    // The host may have it, too: it is told when there is a connection.
    if (!files.isTold) id = draft.id;
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

/** Something else comes in the place of what is written: that is offered, unless it is undone. */
function leave(): void {
  if (!files.isUnsaved) return void keepDraft();
  const left = files.textToSave === restored?.text ? restored : newDraft();
  due.set(left.id, left);
  offers.unshift(left);
  id = freshId();
  isKept = false;
  show();
}

const all = async () => (await values<Draft>(store)).sort((a, b) => b.time - a.time);

/** Keeps a draft under its key, or forgets what is kept there. */
async function stored(id: string, draft: Draft | null): Promise<void> {
  // A browser that forbids it, or takes its time, is no reason not to tell the host.
  const here = storedHere(id, draft).catch(error => { if (!isServed) throw error; });
  await (isServed ? connection.request("studio/draft", draft ?? { id, text: null }) : here);
}

async function storedHere(id: string, draft: Draft | null): Promise<void> {
  if (draft === null) return del(id, store);
  await set(id, draft, store);
  kept.dataset["kept"] = "here";
  await delMany((await all()).slice(MOST).map(({ id }) => id), store);
}
