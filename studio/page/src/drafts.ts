// Drafts: what is written and not saved, kept while one writes, and offered again after a reload, a
// crash, or a host that was lost. What is written before that is answered is kept beside what is
// offered. The served host keeps drafts in a file; the static page the last ten in this browser.

import { createStore, del, delMany, set, values } from "idb-keyval";
import type { Connection } from "./connection";
import { byId, create, createButton } from "./dom";
import type { SceneEditor } from "./editor";
import type { Files } from "./files";
import type { Draft } from "./protocol";
import { setText } from "./visible";

/** How long a text waits until it is kept, in milliseconds, however fast one types. */
const BEHIND = 500;

/** So many drafts are in the browser. */
const MOST = 10;

/** So many are offered at once. */
const OFFERED = 3;
interface Kept extends Draft { id: string }

const store = () => createStore("pinhole-drafts", "drafts");

export class Drafts {
  private timer = 0;
  /** Whether something is kept that this page has written. */
  private isKept = false;
  /** What is offered and not answered yet, the newest first. */
  private unanswered: Draft[] = [];
  private id = `${Date.now()} ${Math.random()}`;
  private readonly bar = byId("draft-bar");

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection,
    private readonly files: Files, private readonly isServed: boolean) {
    byId("draft-later").addEventListener("click", () => (this.bar.hidden = true));
    addEventListener("pagehide", () => void this.keep());
  }

  /** The text has changed. */
  changed(): void { this.timer ||= setTimeout(() => void this.keep(), BEHIND); }

  /** The text is what there is to keep, if it is not saved. */
  async keep(): Promise<void> {
    clearTimeout(this.timer);
    this.timer = 0;
    const { isUnsaved } = this.files;
    if (!(isUnsaved || this.isKept)) return;
    this.isKept = isUnsaved;
    const { draft } = this;
    try {
      if (this.isServed) {
        const earlier = this.unanswered;
        const own = isUnsaved ? draft : { text: null };
        await this.connection.request("studio/draft", { ...own, earlier });
      } else await stored(isUnsaved ? draft : this.id);
    } catch {
      // Without a connection the text is kept when there is one.
      this.isKept = true;
    }
  }

  private get draft(): Kept {
    const { textToSave: text, base } = this.files;
    return { text, base, time: Math.floor(Date.now() / 1000), id: this.id };
  }

  /** Offers what earlier pages have kept. */
  async offer(kept: Draft | null): Promise<void> {
    const { earlier = [], ...newest } = kept ?? {};
    const drafts = kept !== null ? [newest as Draft, ...earlier]
      : this.isServed ? [] : await all().catch(() => []);
    this.unanswered = drafts.filter(it => it.text !== this.files.textToSave);
    this.show();
  }

  private show(): void {
    const { length } = this.unanswered;
    this.bar.hidden = length === 0;
    const were = length === 1 ? "A text was" : `${length} texts were`;
    setText(byId("draft"), `${were} not saved:`);
    byId("draft-choices").replaceChildren(...this.unanswered.slice(0, OFFERED).map(draft => {
      const time = new Date(draft.time * 1000).toLocaleString();
      const isNewer = this.isServed && draft.base !== this.files.seen;
      const newer = isNewer ? " The file has changed since; Save will ask." : "";
      const lines = draft.text.split("\n").length;
      const row = create("li", "", `of ${time}, ${lines} lines.${newer}`);
      row.append(createButton("Restore", "primary", () => this.answer(draft, true)),
        createButton("Forget", "", () => this.answer(draft, false)));
      return row;
    }));
  }

  private answer(draft: Draft, isRestored: boolean): void {
    const { files, isServed, unanswered } = this;
    unanswered.splice(unanswered.indexOf(draft), 1);
    this.isKept = true;
    if (isRestored) {
      // What was written meanwhile is offered in its turn.
      if (files.isUnsaved) {
        unanswered.unshift(this.draft);
        if (!isServed) void stored(this.draft);
      }
      if (!isServed) this.id = (draft as Kept).id;
      files.restore(draft);
    } else if (!isServed) void stored((draft as Kept).id);
    this.show();
    void this.keep();
    this.editor.view.focus();
  }
}

async function all(): Promise<Kept[]> {
  const drafts = await values<Kept>(store());
  return drafts.sort((a, b) => b.time - a.time);
}

/** Keeps a draft in this browser and forgets the oldest ones, or forgets one by its key. */
async function stored(draft: Kept | string): Promise<void> {
  if (typeof draft === "string") return del(draft, store());
  await set(draft.id, draft, store());
  await delMany((await all()).slice(MOST).map(({ id }) => id), store());
}
