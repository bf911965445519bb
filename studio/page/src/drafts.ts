// Drafts: what is written and not saved, kept while one writes, and offered again after a reload, a
// crash, or a host that was lost. The served host keeps them in a file; the static page keeps the
// last ten in this browser.

import type { Connection } from "./connection";
import { byId, createButton } from "./dom";
import type { SceneEditor } from "./editor";
import type { Files } from "./files";
import type { Draft } from "./protocol";
import { setText } from "./visible";

/** How long a text waits until it is kept, in milliseconds, however fast one types. */
const BEHIND = 500;

/** So many drafts are in the browser. */
const MOST = 10;
interface Kept extends Draft { id: string }

export class Drafts {
  private timer = 0;
  /** Whether something is kept that this page has written. */
  private isKept = false;
  private isOffered = false;
  private id = `${Date.now()} ${Math.random()}`;
  private readonly bar = byId("draft-bar");

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection,
    private readonly files: Files, private readonly isServed: boolean) {
    addEventListener("pagehide", () => void this.keep());
  }

  /** The text has changed, or was saved. What is offered is not written over. */
  changed(): void {
    if (this.isOffered) return;
    this.timer ||= setTimeout(() => void this.keep(), BEHIND);
  }

  private async keep(): Promise<void> {
    clearTimeout(this.timer);
    this.timer = 0;
    const { isUnsaved, name, seen, textToSave } = this.files;
    if (this.isOffered || !(isUnsaved || this.isKept)) return;
    this.isKept = isUnsaved;
    const draft = { name, text: textToSave, base: seen };
    try {
      if (this.isServed) {
        await this.connection.request("studio/draft", isUnsaved ? draft : { text: null });
      } else {
        await stored(isUnsaved ? { ...draft, id: this.id, time: Date.now() / 1000 } : this.id);
      }
    } catch {
      // Without a connection the text is kept when there is one.
      this.isKept = true;
    }
  }

  /** Offers what an earlier page has kept; of several drafts the newest first. */
  async offer(kept: Draft | null): Promise<void> {
    const drafts = kept !== null ? [kept] : this.isServed ? [] : await all().catch(() => []);
    this.next(drafts.filter(it => it.text !== this.files.textToSave));
  }

  private next([draft, ...others]: Draft[]): void {
    this.isOffered = draft !== undefined;
    this.bar.hidden = draft === undefined;
    if (draft === undefined) return this.changed();
    const time = new Date(draft.time * 1000).toLocaleString();
    const isNewer = this.isServed && draft.base !== this.files.seen;
    const newer = isNewer ? " The file has changed since; Save will ask." : "";
    setText(byId("draft"), `A text of ${time} was not saved.${newer} Restore it? `
      + "What is written before you answer is not kept.");
    const choose = (act: () => void) => () => {
      act();
      this.editor.view.focus();
    };
    const forget = () => {
      if (this.isServed) void this.connection.request("studio/draft", { text: null });
      else void stored((draft as Kept).id);
      this.next(others);
    };
    byId("draft-choices").replaceChildren(
      createButton("Restore", "primary", choose(() => {
        this.isKept = true;
        if (!this.isServed) this.id = (draft as Kept).id;
        this.next([]);
        this.files.restore(draft);
      })),
      createButton("Forget", "", choose(forget)),
    );
  }
}

/** Does something with the drafts in this browser. */
async function inStore<T>(act: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const settled = <R>(request: IDBRequest<R>) => new Promise<R>((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error as Error);
  });
  const opening = indexedDB.open("pinhole", 1);
  opening.onupgradeneeded = () => opening.result.createObjectStore("drafts", { keyPath: "id" });
  const database = await settled(opening);
  try {
    return await settled(act(database.transaction("drafts", "readwrite").objectStore("drafts")));
  } finally { database.close(); }
}

async function all(): Promise<Kept[]> {
  const drafts = await inStore<Kept[]>(store => store.getAll());
  return drafts.sort((a, b) => b.time - a.time);
}

/** Keeps a draft in this browser and forgets the oldest ones, or forgets one by its key. */
async function stored(draft: Kept | string): Promise<void> {
  if (typeof draft === "string") return inStore(store => store.delete(draft));
  await inStore(store => store.put(draft));
  for (const { id } of (await all()).slice(MOST)) await inStore(store => store.delete(id));
}
