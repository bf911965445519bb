// Drafts: what is written and not saved, kept while one writes, and offered again after a reload, a
// crash, or a host that was lost. What is written before that is answered is kept beside what is
// offered. The served host keeps drafts in a file; the static page the last ten in this browser.

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
interface Kept extends Draft { id: string }

const store = isServed ? undefined : createStore("pinhole-drafts", "drafts");

let timer = 0;
/** Whether something is kept that this page has written. */
let isKept = false;
/** What is offered and not answered yet, the newest first. */
let unanswered: Draft[] = [];
const freshId = () => `${Date.now()} ${Math.random()}`;
let id = freshId();
const bar = byId("draft-bar");

byId("draft-later").addEventListener("click", () => (bar.hidden = true));
addEventListener("pagehide", () => void keepDraft());
files.onLeave = leave;

/** The text has changed. */
export function draftChanged(): void { timer ||= setTimeout(() => void keepDraft(), BEHIND); }

/** The text is what there is to keep, if it is not saved. */
export async function keepDraft(): Promise<void> {
  clearTimeout(timer);
  timer = 0;
  const { isUnsaved } = files;
  if (!(isUnsaved || isKept)) return;
  isKept = isUnsaved;
  try {
    if (isServed) {
      const earlier = unanswered;
      const own = isUnsaved ? newDraft() : { text: null };
      await connection.request("studio/draft", { ...own, earlier });
    } else await stored(isUnsaved ? newDraft() : id);
  } catch (error) {
    // Without a connection the text is kept when there is one.
    isKept = true;
    if (error instanceof Refusal) say(`No draft is kept: ${error.message}`, "warning");
  }
}

function newDraft(): Kept {
  const { textToSave: text, at: { base } } = files;
  return { text, base, time: Math.floor(Date.now() / 1000), id };
}

/** Offers what earlier pages have kept. */
export async function offerDrafts(kept: Draft | null): Promise<void> {
  const { earlier = [], ...newest } = kept ?? {};
  const drafts = kept !== null ? [newest as Draft, ...earlier]
    : isServed ? [] : await all().catch(() => []);
  unanswered = drafts.filter(it => it.text !== files.textToSave);
  show();
}

function show(): void {
  bar.hidden = unanswered.length === 0;
  byId("draft-choices").replaceChildren(...unanswered.slice(0, OFFERED).map(draft => {
    const time = new Date(draft.time * 1000).toLocaleString();
    const isOther = isServed && draft.base !== files.at.seen;
    const newer = !isOther ? "" : draft.base === null ? " It was a scene of its own."
      : " The file has changed since; Save will ask.";
    const lines = draft.text.split("\n").length;
    const row = create("li", "", `of ${time}, ${lines} lines.${newer}`);
    row.append(createButton("Restore", "primary", () => answer(draft, true)),
      createButton("Forget", "", () => answer(draft, false)));
    return row;
  }));
}

function answer(draft: Draft, isRestored: boolean): void {
  unanswered.splice(unanswered.indexOf(draft), 1);
  isKept = true;
  if (isRestored) {
    leave();
    if (!isServed) id = (draft as Kept).id;
    files.restore(draft);
  } else if (!isServed) void stored((draft as Kept).id);
  show();
  void keepDraft();
  editor.view.focus();
}

/** Something else comes in the place of what is written, which is offered in its turn, or
 *  forgotten under its own key if it has just been undone. */
function leave(): void {
  if (!files.isUnsaved) return void keepDraft();
  unanswered.unshift(newDraft());
  if (!isServed) void stored(newDraft());
  id = freshId();
  show();
}

const all = async () => (await values<Kept>(store)).sort((a, b) => b.time - a.time);

/** Keeps a draft in this browser and forgets the oldest ones, or forgets one by its key. */
async function stored(draft: Kept | string): Promise<void> {
  if (typeof draft === "string") return del(draft, store);
  await set(draft.id, draft, store);
  await delMany((await all()).slice(MOST).map(({ id }) => id), store);
}
