// Where the scene is kept: the host's file, which other editors may change at the same time, or a file of this computer that the browser opens and saves.

import example from "../../../examples/figure_9_9.scn";
import type { Connection } from "./connection";
import { byId, create, createButton } from "./dom";
import type { SceneEditor } from "./editor";
import { Refusal, type HostedFile } from "./protocol";
import { download } from "./share";
import type { Status } from "./status";

/** What browsers that can save into files offer for it. */
interface FileHandle {
  name: string;
  getFile(): Promise<File>;
  createWritable(): Promise<{ write(text: string): Promise<void>; close(): Promise<void> }>;
}

interface FilePickers {
  showOpenFilePicker?(options: object): Promise<FileHandle[]>;
  showSaveFilePicker?(options: object): Promise<FileHandle>;
}

const pickers = window as unknown as FilePickers;
const SCENES = { types: [{ description: "Scenes", accept: { "text/plain": [".scn"] } }] };

/** More lines than these are not compared one by one. */
const MOST_LINES = 3000;

/** The host keeps a file of its own with the text as the page last saw it there; a static page has local files alone. */
export class Files {
  name = "scene.scn";
  /** What is on disk, as far as the page knows; null for nothing. */
  private base: string | null = null;
  private handle: FileHandle | null = null;
  /** Whether the host's file is still to be made, under a name that Save asks for. */
  private isNew = false;
  private opened = false;
  /** The text that a new scene starts with: as long as it stands there, nothing is lost with it. Null for what was a file once. */
  private untouched: string | null = null;

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection, private readonly status: Status, private readonly isServed: boolean) {
    byId("save").addEventListener("click", () => void this.save());
    byId("open").addEventListener("click", () => void this.open());
    byId("open").hidden = isServed;
    addEventListener("beforeunload", event => {
      if (this.isUnsaved) event.preventDefault();
    });
  }

  get isUnsaved(): boolean {
    const { text } = this.editor;
    return this.opened && text !== this.base && !(this.base === null && text === this.untouched);
  }

  /** The host says which file it has: at first, after the connection was lost, and when a new scene has got its name. */
  hosted({ name, text, uri, saved }: HostedFile, linked: string | null): void {
    this.name = name;
    this.isNew = this.isServed && !saved;
    if (!this.opened) {
      this.opened = true;
      this.base = saved ? text : null;
      const start = this.isServed ? (text ?? "") : example;
      this.untouched = saved ? null : start;
      this.editor.open(uri, start);
      if (linked !== null) this.editor.replace(linked);
      // Who opens a link has the scene in it, whatever happens to the page.
      if (!this.isServed) this.untouched = this.editor.text;
      if (text === null) this.status.say(`${name} cannot be read: it is gone, or no text.`, "warning");
    } else {
      this.editor.moveTo(uri);
      if (this.isServed && saved) this.changed(text);
    }
    this.show();
  }

  /** The file was changed by somebody else, or is gone. */
  changed(text: string | null): void {
    const { base } = this;
    if (text === base) return;
    if (text === null) {
      this.base = null;
      this.status.say(`${this.name} cannot be read any more: it is gone, or no text. Save writes it anew.`, "warning");
    } else if (this.editor.text === text || this.editor.text === base) {
      this.base = text;
      this.editor.replace(text);
      this.status.say(`${this.name} was changed outside; the page follows.`);
    } else {
      this.ask(text);
    }
    this.show();
  }

  /** Shows whether everything is saved. */
  show(): void {
    byId("file-name").textContent = this.name;
    const { isUnsaved } = this;
    byId("file-state").textContent = isUnsaved ? "not saved" : "";
    const title = `${isUnsaved ? "• " : ""}${this.name} – Pinhole Studio`;
    if (document.title !== title) document.title = title;
  }

  async save(): Promise<void> {
    try {
      if (this.isServed) await this.saveHosted();
      else await this.saveLocal();
    } catch (error) {
      if ((error as Error).name !== "AbortError") this.status.say((error as Error).message, "warning");
    }
    this.show();
  }

  private async saveHosted(): Promise<void> {
    const { text } = this.editor;
    if (this.isNew) {
      const name = await this.askName();
      if (name === null) return;
      this.name = name;
    }
    try {
      await this.connection.request("studio/save", { text, base: this.base, ...(this.isNew ? { name: this.name } : {}) });
      this.base = text;
      this.isNew = false;
      this.status.say(`${this.name} is saved.`);
    } catch (error) {
      if (!(error instanceof Refusal) || error.code !== 1) throw error;
      const { text: held } = error.data as { text: string | null };
      if (held === null) this.changed(null);
      else this.ask(held);
    }
  }

  /** The name that a new file shall have; null if it shall not be saved. */
  private askName(): Promise<string | null> {
    const dialog = byId<HTMLDialogElement>("name-dialog");
    const field = byId<HTMLInputElement>("name-field");
    field.value = this.name;
    dialog.returnValue = "";
    dialog.showModal();
    field.select();
    return new Promise(resolve => {
      dialog.addEventListener("close", () => resolve(dialog.returnValue === "save" && field.value.trim() !== "" ? field.value.trim() : null), { once: true });
    });
  }

  private async saveLocal(): Promise<void> {
    const { text } = this.editor;
    this.handle ??= (await pickers.showSaveFilePicker?.({ ...SCENES, suggestedName: this.name })) ?? null;
    if (this.handle === null) {
      download(this.name, text, "text/plain");
    } else {
      // The browser writes into a copy, which takes the file's place as a whole on closing.
      const file = await this.handle.createWritable();
      await file.write(text);
      await file.close();
      this.name = this.handle.name;
    }
    this.base = text;
    this.status.say(`${this.name} is saved.`);
  }

  private async open(): Promise<void> {
    try {
      if (pickers.showOpenFilePicker !== undefined) {
        const [handle] = await pickers.showOpenFilePicker(SCENES);
        if (handle !== undefined) this.take(await handle.getFile(), handle);
        return;
      }
      const input = create("input");
      input.type = "file";
      input.accept = ".scn,text/plain";
      input.addEventListener("change", () => {
        const file = input.files?.[0];
        if (file !== undefined) void this.take(file, null);
      });
      input.click();
    } catch (error) {
      if ((error as Error).name !== "AbortError") this.status.say((error as Error).message, "warning");
    }
  }

  private async take(file: File, handle: FileHandle | null): Promise<void> {
    const text = await file.text();
    this.name = file.name;
    this.handle = handle;
    this.editor.replace(text);
    this.base = this.editor.text;
    this.show();
  }

  /** Both the page and the file have changed: shows the difference, and asks. Whatever is chosen, undo brings the other text back. */
  private ask(theirs: string): void {
    const dialog = byId<HTMLDialogElement>("conflict-dialog");
    const lines = byId("conflict-lines");
    lines.replaceChildren(...difference(theirs, this.editor.text).map(({ sign, text }) => create("div", sign === "-" ? "removed" : sign === "+" ? "added" : "", `${sign} ${text}`)));
    byId("conflict-name").textContent = this.name;
    const choose = (act: () => void) => () => {
      dialog.close();
      act();
      this.show();
    };
    byId("conflict-choices").replaceChildren(
      createButton("Keep the page's text and save it", "primary", choose(() => {
        this.base = theirs;
        void this.save();
      })),
      createButton("Take the file's text", "", choose(() => {
        this.base = theirs;
        this.editor.replace(theirs);
      })),
      // Saving will ask again, because the page's base is still the older one.
      createButton("Decide later", "", choose(() => {})),
    );
    if (!dialog.open) dialog.showModal();
  }
}

interface DifferenceLine {
  sign: " " | "-" | "+";
  text: string;
}

/** The lines of two texts: those of the first alone by -, those of the second alone by +, with up to two common ones around (longest common subsequence). */
export function difference(one: string, other: string): DifferenceLine[] {
  const [a, b] = [one.split("\n"), other.split("\n")];
  let start = 0;
  while (start < a.length && start < b.length && a[start] === b[start]) start++;
  let end = 0;
  while (end < a.length - start && end < b.length - start && a[a.length - 1 - end] === b[b.length - 1 - end]) end++;
  const common = (lines: string[]): DifferenceLine[] => lines.map(text => ({ sign: " ", text }));
  const middle = changedLines(a.slice(start, a.length - end), b.slice(start, b.length - end));
  return [...common(a.slice(Math.max(0, start - 2), start)), ...middle, ...common(a.slice(a.length - end, a.length - end + 2))];
}

function changedLines(a: string[], b: string[]): DifferenceLine[] {
  const lines: DifferenceLine[] = [];
  const [n, m] = [a.length, b.length];
  // lengths[i * (m + 1) + j] is that of the longest common subsequence of a from i on and b from j on.
  const isLong = n > MOST_LINES || m > MOST_LINES;
  const lengths = isLong ? new Uint16Array(0) : new Uint16Array((n + 1) * (m + 1));
  const at = (i: number, j: number) => lengths[i * (m + 1) + j] ?? 0;
  if (!isLong) {
    for (let i = n - 1; i >= 0; i--) for (let j = m - 1; j >= 0; j--) lengths[i * (m + 1) + j] = a[i] === b[j] ? at(i + 1, j + 1) + 1 : Math.max(at(i + 1, j), at(i, j + 1));
  }
  let [i, j] = [0, 0];
  while (i < n || j < m) {
    if (!isLong && i < n && j < m && a[i] === b[j]) {
      lines.push({ sign: " ", text: a[i++] ?? "" });
      j++;
    } else if (i < n && (j >= m || at(i + 1, j) >= at(i, j + 1))) lines.push({ sign: "-", text: a[i++] ?? "" });
    else lines.push({ sign: "+", text: b[j++] ?? "" });
  }
  return lines;
}
