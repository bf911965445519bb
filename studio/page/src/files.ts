// Where the scene is kept: the host's file, which other editors may change at the same time, or a
// file of this computer that the browser opens and saves.

import { diffArrays } from "diff";
import example from "../../../examples/figure_9_9.scn";
import type { Connection } from "./connection";
import { byId, create, createButton, download } from "./dom";
import { withLf, type SceneEditor } from "./editor";
import { Refusal, type Draft, type HostedFile, type Saved } from "./protocol";
import type { Status } from "./status";
import { setText, visibleLine } from "./visible";

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

/** How long a save may take before it is said that it is not done, in milliseconds. */
const SLOW = 800;
const LONE = /\r(?!\n)/; // a carriage return that ends no line
const NOT_SAVED = "Nothing was saved, because there is no connection. The text stays here.";
const NOT_YET = "Nothing is saved yet: Studio does not answer.";

/** Of texts with more changed lines than these it is not said which ones stay. */
const MOST_CHANGES = 3000;

/** The host's file as the page last saw it; a static page has local files alone. */
export class Files {
  name = "scene.scn";
  onSaved: () => void = () => {};
  /** What the page's text was made from: Save asks if the file holds something else. */
  base: string | null = null;
  private held: string | null = null;
  /** Whether the file has gone since. */
  private isGone = false;
  private handle: FileHandle | null = null;
  /** Whether the host's file is still to be made, under a name that Save asks for. */
  private isNew = false;
  private opened = false;
  /** The text that a new scene starts with, which is not worth saving; null for a file. */
  private untouched: string | null = null;
  private readonly conflict = byId<HTMLDialogElement>("conflict-dialog");

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection,
    private readonly status: Status, private readonly isServed: boolean) {
    byId("save").addEventListener("click", () => void this.save());
    byId("open").addEventListener("click", () => void this.open());
    byId("open").hidden = isServed;
    addEventListener("beforeunload", event => { if (this.isUnsaved) event.preventDefault(); });
  }

  /** The name as people may see it. */
  private get shownName(): string { return visibleLine(this.name); }

  get isUnsaved(): boolean {
    const { text } = this.editor;
    return this.opened && text !== this.untouched
      && (this.isGone || this.seen === null || text !== withLf(this.seen) || LONE.test(this.seen));
  }

  /** What the file held when it was last seen; null where there was none. */
  get seen(): string | null { return this.held; }
  private set seen(text: string | null) { this.held = this.base = text; }

  /** The text with its file's ends of lines. */
  get textToSave(): string { return withEndsOf(this.seen ?? "", this.editor.text); }

  /** Puts a draft in place. */
  restore(draft: Draft): void {
    if (this.seen !== null) this.base = draft.base;
    this.editor.replace(draft.text);
    this.show();
  }

  /** The host says what file it has: at first, after the connection was lost, when a new scene
   *  has got its name, and when the file has changed. */
  hosted({ name, text, reason, saved }: HostedFile, linked: string | null): void {
    this.name = name;
    this.isNew = this.isServed && !saved;
    if (!this.opened) {
      this.opened = true;
      this.seen = saved ? text : null;
      const start = this.isServed ? (text ?? "") : example;
      this.untouched = saved ? null : withLf(start);
      this.editor.open(start);
      this.tellLone();
      if (linked !== null) this.editor.replace(linked);
      // Who opens a link has the scene in it, whatever happens to the page.
      if (!this.isServed) this.untouched = this.editor.text;
      if (text === null) this.tellGone(reason);
    } else if (this.isServed && saved) {
      this.untouched = null;
      this.changed(text, reason);
    }
    this.editor.start();
    this.show();
  }

  /** The file was changed by somebody else, is gone, or is back. */
  private changed(text: string | null, reason?: string | null): void {
    const { seen, isGone } = this;
    this.isGone = text === null;
    if (text === null) {
      if (!isGone) this.tellGone(reason);
    } else if (text === seen) {
      // It is again what the page was made from: there is nothing to decide any more.
      this.conflict.close();
    } else if (this.editor.text === withLf(text)
      || (seen !== null && this.editor.text === withLf(seen))) {
      this.conflict.close();
      this.seen = text;
      this.editor.replace(text);
      this.status.say(`${this.shownName} was changed outside; the page follows.`);
      this.tellLone();
    } else this.ask(text);
    this.show();
  }

  /** A page cannot show the file as the language reads it: nothing is changed without a word. */
  private tellLone(): void {
    if (LONE.test(this.seen ?? "")) this.status.say(`${this.shownName} has carriage returns alone, `
      + "which end no line in a scene; Save writes line feeds in their place.", "warning");
  }

  private tellGone(reason?: string | null): void {
    this.isGone = true;
    this.status.say(reason ? `${this.shownName} cannot be read: ${reason}`
      : `${this.shownName} is gone; Save writes it anew.`, "warning");
  }

  /** Shows whether everything is saved. */
  show(): void {
    setText(byId("file-name"), this.shownName);
    const { isUnsaved } = this;
    setText(byId("file-state"), isUnsaved ? "not saved" : "");
    const title = `${isUnsaved ? "• " : ""}${this.shownName} – Pinhole Studio`;
    if (document.title !== title) document.title = title;
  }

  async save(): Promise<void> {
    try {
      if (!this.isServed) await this.saveLocal();
      else if (this.isNew) this.askName();
      else await this.saveAs(this.name);
    } catch (error) { this.failed(error as Error); }
    this.show();
  }

  /** Says what kept a file from being saved or opened, unless that was the user. */
  private failed({ name, message }: Error): void {
    if (name !== "AbortError") this.status.say(message, "warning");
  }

  private async saveAs(name: string): Promise<void> {
    if (this.connection.state !== "open") throw new Error(NOT_SAVED);
    const text = this.textToSave;
    const about = { text, base: this.isGone ? null : this.base, ...(this.isNew ? { name } : {}) };
    const slow = setTimeout(() => this.status.say(NOT_YET, "warning"), SLOW);
    try {
      const answer = await this.connection.request<Saved>("studio/save", about);
      if (answer.ok) {
        this.saved(name, text);
        this.isNew = false;
      } else if (answer.text === null) this.changed(null);
      else this.ask(answer.text);
    } catch (error) {
      throw error instanceof Refusal ? error : new Error(NOT_SAVED);
    } finally { clearTimeout(slow); }
  }

  private saved(name: string, text: string): void {
    this.name = name;
    this.seen = text;
    this.isGone = false;
    this.untouched = null;
    this.status.say(`${this.shownName} is saved.`);
    this.onSaved();
  }

  /** Asks for the name of a new file, and saves it. While that fails, the dialog stays. */
  private askName(): void {
    const dialog = byId<HTMLDialogElement>("name-dialog");
    const field = byId<HTMLInputElement>("name-field");
    const problem = byId("name-problem");
    setText(problem, "");
    field.value = this.name;
    byId("name-form").onsubmit = async event => {
      if ((event.submitter as HTMLButtonElement | null)?.value === "") return;
      event.preventDefault();
      const name = field.value.trim();
      try {
        await this.saveAs(name.endsWith(".scn") ? name : `${name}.scn`);
        dialog.close();
      } catch (error) {
        setText(problem, (error as Error).message);
        field.select();
      }
      this.show();
    };
    dialog.showModal();
    field.select();
  }

  private async saveLocal(): Promise<void> {
    const text = this.textToSave;
    this.handle ??= (await pickers.showSaveFilePicker?.({ ...SCENES, suggestedName: this.name }))
      ?? null;
    if (this.handle === null) {
      download(this.name, text, "text/plain");
    } else {
      // The browser writes into a copy, which takes the file's place as a whole on closing.
      const file = await this.handle.createWritable();
      await file.write(text);
      await file.close();
    }
    this.saved(this.handle?.name ?? this.name, text);
  }

  private async open(): Promise<void> {
    const question = "The scene on the page is not saved. Open another one in its place?";
    if (this.isUnsaved && !confirm(question)) return;
    try {
      if (pickers.showOpenFilePicker !== undefined) {
        const [handle] = await pickers.showOpenFilePicker(SCENES);
        if (handle !== undefined) await this.take(await handle.getFile(), handle);
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
    } catch (error) { this.failed(error as Error); }
  }

  private async take(file: File, handle: FileHandle | null): Promise<void> {
    try {
      // Other encodings would come back from Save as another text.
      const text = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true })
        .decode(await file.arrayBuffer());
      this.editor.open(text);
      this.handle = handle;
      this.name = file.name;
      this.seen = text;
      this.untouched = null;
      this.tellLone();
    } catch { this.status.say(`${visibleLine(file.name)} is no text in UTF-8.`, "warning"); }
    this.show();
  }

  /** Shows how page and file differ, and asks. Undo brings back what is not chosen. */
  private ask(theirs: string): void {
    const lines = difference(withLf(theirs), this.editor.text)
      .map(({ sign, text }) => create("div", CLASSES[sign], `${sign} ${text}`));
    byId("conflict-lines").replaceChildren(...lines);
    setText(byId("conflict-name"), this.shownName);
    const choose = (act: () => void) => () => {
      this.conflict.close();
      act();
      this.show();
    };
    byId("conflict-choices").replaceChildren(
      createButton("Keep the page's text and save it", "primary", choose(() => {
        this.seen = theirs;
        void this.save();
      })),
      createButton("Take the file's text", "", choose(() => {
        this.seen = theirs;
        this.editor.replace(theirs);
      })),
      // Saving will ask again, because the page's text is still made from an older one.
      createButton("Decide later", "", choose(() => {})),
    );
    if (!this.conflict.open) this.conflict.showModal();
  }
}

/** A text with the ends of lines that a file has; a new line ends as the one before it. A carriage
 *  return alone ends none. */
export function withEndsOf(file: string, text: string): string {
  if (!file.includes("\r")) return text;
  const ends = file.match(/\r\n?|\n/g)?.map(end => end === "\r" ? "\n" : end) ?? [];
  let [i, end, made] = [0, ends[0] ?? "\n", ""];
  const lines = compared(withLf(file).split("\n"), text.split("\n"));
  const last = lines.findLastIndex(line => line.sign !== "-");
  lines.forEach(({ sign, text }, at) => {
    if (sign !== "+") end = ends[i++] ?? end;
    if (sign !== "-") made += at === last ? text : text + end;
  });
  return made;
}

const CLASSES = { " ": "", "-": "removed", "+": "added" };
interface DifferenceLine { sign: " " | "-" | "+"; text: string }

/** Where two texts differ, with up to two lines around. */
export function difference(one: string, other: string): DifferenceLine[] {
  const lines = compared(one.split("\n"), other.split("\n"));
  const differs = ({ sign }: DifferenceLine) => sign !== " ";
  return lines.slice(Math.max(0, lines.findIndex(differs) - 2), lines.findLastIndex(differs) + 3);
}

/** The lines of two texts: those of the first alone by -, those of the second alone by +. */
function compared(a: string[], b: string[]): DifferenceLine[] {
  const parts = diffArrays(a, b, { maxEditLength: MOST_CHANGES })
    ?? [{ value: a, removed: true, added: false }, { value: b, removed: false, added: true }];
  return parts.flatMap(({ value, added, removed }) =>
    value.map((text): DifferenceLine => ({ sign: added ? "+" : removed ? "-" : " ", text })));
}
