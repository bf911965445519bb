// The scene's file: either the file of the host, which other editors may change at the same time,
// or a local file that the browser opens and saves.

import { diffArrays } from "diff";
import { invertedEffects, isolateHistory } from "@codemirror/commands";
import { StateEffect, type Extension, type Transaction } from "@codemirror/state";
import { connection, isServed } from "./connection";
import { byId, create, createButton, download } from "./dom";
import { editor, withLf } from "./editor";
import { pastOf } from "./gesture";
import { panel } from "./panel";
import { Refusal, type HostedFile, type Saved } from "./protocol";
import { say, unsay } from "./status";
import { setText, visibleLine } from "./visible";

/** Text of the scene that a page without a file shows first. */
const FIGURE = EXAMPLES.find(([name]) => name === "figure_9_9")?.[1] ?? EMPTY;
/** The browser's file pickers; undefined in browsers without them. */
const pickers: Partial<Pick<typeof window, `show${"Open" | "Save"}FilePicker`>> = window;
const SCENES = { types: [{ description: "Scenes", accept: { "text/plain": ".scn" as const } }] };

const UNNAMED = "scene.scn";

/** A scene and its file. */
class Scene {
  /** Content of the file when it was last read; null if there was no file. */
  seen: string | null = null;
  /** Content of the file when editing began; null if there was no file. If the file now differs
   * from it, Save asks first. */
  base: string | null = null;
  /** Whether the file was removed after it was read. */
  isGone = false;
  handle: FileSystemFileHandle | null = null;
  copy: Scene | null = null; // copy that replaced this scene when it was saved by Save as
  /** Whether the host has no file for the scene yet, so that Save asks for a name. */
  isNew = isServed;
  /** Initial text of a new scene, which need not be saved; null if the scene comes from a file. */
  untouched: string | null = null;
  /** `link` if the scene comes from a link; null otherwise. */
  from: "link" | null = null;

  /** Creates a scene. If `of` is given, the new scene is a copy of `of` under another name, and
   * becomes the current scene when it is saved. */
  constructor(public name = UNNAMED, readonly of: Scene | null = null) {}

  /** Last known content of the file, or the initial text if there is no file. */
  get held(): string { return this.seen ?? this.untouched ?? ""; }

  /** Returns whether `text` differs from the file's content and from the initial text. In a panel,
   * VS Code saves the text, so the result is always false. */
  isChangedBy(text: string): boolean {
    const { isGone, seen, untouched } = this;
    return !panel && (untouched === null || text !== withLf(untouched))
      && (isGone || seen === null || text !== withLf(seen) || LONE.test(seen));
  }
}

/** Effect of a change that replaces one scene by another. Undo restores the first scene. */
const sceneSwitch = StateEffect.define<{ from: Scene; to: Scene }>();

export const sceneHistory: Extension = invertedEffects.of(({ effects }) => effects
  .filter(it => it.is(sceneSwitch))
  .map(({ value: { from, to } }) => sceneSwitch.of({ from: to, to: from })));

/** Time after which an unfinished save is reported, in ms. A usual save takes less. */
const SLOW = 800;
const LONE = /\r(?!\n)/; // a carriage return that ends no line
const NOT_SAVED = "Nothing was saved, because there is no connection. The text stays here.";

/** Maximum number of removed and added lines in a comparison of two texts. If there are more, a
 * comparison would take too long, so all lines are shown as removed or added. */
const MOST_CHANGES = 3000;

/** The host's file and local files. A page without a host has only local files. */
class Files {
  onSaved: (text: string) => void = () => {};
  /** Called before another scene replaces the current one. */
  onLeave: () => void = () => {};
  /** Closes the open lesson if its scene is shown. Then the user's own scene is shown again. */
  closeLesson: () => void = () => {};
  /** Whether the host has sent its scene to this page. */
  hasHostFile = false;
  /** Draft, or scene of a link, that was restored before the host sent its scene; null if there is
   * none. `base` is the content of the draft's file when editing began, or null if there was no
   * file. For a link, `base` is undefined. */
  private restoredEarly: { base: string | null | undefined; text: string } | null = null;
  /** The scene of the host's file. */
  private hostScene = new Scene();
  /** The scene that the page shows. */
  current = this.hostScene;
  /** Newest state of the host's file, if it arrived while another scene was shown. */
  private pendingHostFile: HostedFile | null = null;
  /** Scene, text and undo history that the scene of a lesson has replaced; null if no lesson's
   * scene is shown. */
  private beforeLesson: { scene: Scene; text: string; past: Extension } | null = null;
  private readonly conflict = byId<HTMLDialogElement>("conflict-dialog");

  constructor() {
    byId("save").addEventListener("click", () => void this.save());
    byId("save-as").addEventListener("click",
      () => void this.save(new Scene(this.current.name, this.current)));
    byId("open").addEventListener("click", () => void this.attempt(() => this.open()));
    byId("file").addEventListener("change", ({ target }) => {
      const [file] = (target as HTMLInputElement).files ?? [];
      if (file !== undefined) void this.take(file, null);
      (target as HTMLInputElement).value = ""; // The same file can be chosen again.
    });
    byId("new").addEventListener("click", () => this.replaceBy(EMPTY));
    for (const [name, text] of EXAMPLES) byId("examples").append(
      createButton(name.replace(/(\d)_(\d)/, "$1.$2").replaceAll("_", " "), "",
        () => this.start(`${name}.scn`, text)));
    addEventListener("beforeunload", event => {
      const { isUnsaved, beforeLesson } = this;
      if (isUnsaved || beforeLesson?.scene.isChangedBy(beforeLesson.text)) event.preventDefault();
    });
  }

  /** Shows a new scene with this name and text. Undo restores the old scene. */
  start(name: string, text: string): void { this.replaceBy(text, new Scene(name)); }

  private startLink(text: string): void {
    this.replaceBy(text, Object.assign(new Scene(), { from: "link" }));
  }

  /** Shows the scene of a lesson. Its initial text is `start`; `text` is what the user has made of
   * it so far. Undo does not leave the lesson: `leaveLesson` restores the user's own scene. */
  startLesson(name: string, start: string, text: string): void {
    if (!this.hasHostFile) return say("Studio is not ready yet.", "warning");
    if (this.beforeLesson === null) {
      this.onLeave();
      this.beforeLesson = { scene: this.current, text: editor.text, past: pastOf(editor.view) };
    }
    this.current = Object.assign(new Scene(name), { untouched: start });
    editor.open(text);
  }

  /** Shows the user's own scene again if the scene of a lesson has replaced it. */
  leaveLesson(): void {
    if (this.beforeLesson === null) return;
    const { scene, text, past } = this.beforeLesson;
    this.beforeLesson = null;
    this.current = scene;
    editor.open(text, past);
    this.followHost();
  }

  /** Whether the scene of a lesson is shown. */
  get isLesson(): boolean { return this.beforeLesson !== null; }

  /** Handles a change of the host's file that arrived while another scene was shown. The change is
   * handled in a microtask, because now a transaction may be under way, or another scene may be
   * about to replace the host's scene again. */
  private followHost(): void {
    queueMicrotask(() => {
      const { current, hostScene, pendingHostFile } = this;
      if (current === hostScene && pendingHostFile) this.hosted(pendingHostFile);
    });
  }

  /** Replaces the shown scene by the scene `to` with this text. Undo restores the old scene. If a
   * lesson's scene is shown, the user's own scene first replaces it, so Undo restores the own
   * scene. */
  private replaceBy(text: string, to = new Scene()): void {
    if (!this.hasHostFile) return say("Studio is not ready yet.", "warning");
    this.closeLesson();
    this.onLeave();
    to.untouched = to.seen === null ? text : null;
    const { view } = editor;
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: withLf(text) },
      selection: { anchor: 0 }, scrollIntoView: true, annotations: isolateHistory.of("full"),
      effects: sceneSwitch.of({ from: this.current, to }) });
  }

  /** After Undo, Redo or the start of a new scene, sets `current` to the scene that the editor
   * shows. If this scene was saved under another name, sets `current` to its newest copy. */
  follow(transactions: readonly Transaction[]): void {
    for (const { effects } of transactions) for (const it of effects) {
      if (!it.is(sceneSwitch)) continue;
      for (let at: Scene | null = it.value.to; at; at = at.copy) this.current = at;
      this.followHost();
    }
  }

  private get shownName(): string { return visibleLine(this.current.name); }

  get isUnsaved(): boolean { return editor.uri !== "" && this.current.isChangedBy(editor.text); }

  /** The text with the line ends that its file has. */
  get textToSave(): string { return withEndsOf(this.current.held, editor.text); }

  /** Shows the text of a draft or of a link. For a link, `base` is undefined. */
  restore(text: string, base?: string | null, name = this.current.name): void {
    if (!this.hasHostFile) {
      this.restoredEarly = { base, text };
      const untouched = base === undefined ? text : null;
      Object.assign(this.current, { name, base: base ?? null, untouched });
    } else if (base === undefined) return this.startLink(text);
    else if (this.current.seen !== null) this.current.base = base;
    editor.replace(text);
    editor.start();
    this.show();
  }

  /** Handles the host's file. The host sends it at the start and after each change of the file. */
  hosted(file: HostedFile): void {
    const { name, text, reason, saved } = file;
    unsay(NOT_SAVED);
    Object.assign(this.hostScene, { name, isNew: isServed && !saved });
    // While the page shows another scene, the text of the host's file must not replace that scene's
    // text. It is handled later.
    this.pendingHostFile = this.current === this.hostScene ? null : file;
    if (this.pendingHostFile !== null) return this.show();
    if (!this.hasHostFile) {
      const [early, { view: { state: { selection } } }] = [editor.text, editor];
      this.hasHostFile = true;
      this.current.seen = this.current.base = saved ? text : null;
      const start = saved ? (text ?? "") : isServed ? EMPTY : FIGURE;
      this.current.untouched = saved ? null : start;
      editor.open(start);
      this.tellLone();
      if (this.restoredEarly !== null) {
        const { base, text } = this.restoredEarly;
        if (base === undefined) {
          // The scene of a link is not the host's file, so Save must not write to that file. Its
          // text remains in the page's address, so it is not lost if the user never saves it.
          this.startLink(text);
          editor.replace(early);
        } else this.restore(early, base);
        editor.view.dispatch({ selection });
      }
      if (saved && text === null) this.tellGone(reason);
    } else if (isServed && saved) {
      this.current.untouched = null;
      this.changed(text, reason);
    }
    editor.start();
    this.show();
  }

  /** Handles a change of the file by another program; `text` is null if it was removed. */
  private changed(text: string | null, reason?: string | null): void {
    const { seen, isGone } = this.current;
    this.current.isGone = text === null;
    if (text === null) {
      if (!isGone) this.tellGone(reason);
    } else if (text === seen) {
      // The file has the content that the page has read before, so the user need not choose between
      // two texts. This happens if another program restores the file.
      this.conflict.close();
      if (isGone) say(`${this.shownName} is there again.`);
    } else if (editor.text === withLf(text) || (seen !== null && editor.text === withLf(seen))) {
      this.conflict.close();
      this.current.seen = this.current.base = text;
      editor.replace(text);
      say(`${this.shownName} was changed outside; the page follows.`);
      this.tellLone();
    } else this.ask(text);
    this.show();
  }

  /** Warns of lone carriage returns, which the page cannot show. Save replaces them by LF. */
  private tellLone(): void {
    if (LONE.test(this.current.held)) say(`${this.shownName} has carriage returns `
      + "alone, which end no line in a scene; Save writes line feeds in their place.", "warning");
  }

  private tellGone(reason?: string | null): void {
    this.current.isGone = true;
    say(reason ? `${this.shownName} cannot be read: ${reason}`
      : `${this.shownName} is gone; Save writes it anew.`, "warning");
  }

  /** Shows the file's name, and whether the text has unsaved changes. */
  show(): void {
    setText(byId("file-name"), this.shownName);
    const { isUnsaved } = this;
    setText(byId("file-state"), isUnsaved ? "not saved" : "");
    const title = `${isUnsaved ? "• " : ""}${this.shownName} – Pinhole Studio`;
    if (document.title !== title) document.title = title;
  }

  save(scene = this.current): Promise<void> {
    return this.attempt(async () => {
      if (!isServed) await this.saveLocal(scene);
      else if (scene.isNew && connection.state === "open") this.askName(scene);
      else await this.saveAs(scene, scene.name);
    });
  }

  /** Runs `act`. If it fails, shows the reason, unless the user has cancelled it. */
  private async attempt(act: () => Promise<void>): Promise<void> {
    await act().catch(({ name, message }: Error) => {
      if (name !== "AbortError") say(message, "warning");
    });
    this.show();
  }

  private async saveAs(scene: Scene, name: string): Promise<void> {
    if (connection.state !== "open") throw new Error(NOT_SAVED);
    const { hostScene, textToSave: text } = this;
    const { isGone, isNew, base } = scene;
    const isHosts = scene === hostScene && !isNew;
    const isTaken = !isHosts && !hostScene.isNew && name === hostScene.name;
    if (isTaken) throw new Refusal(0, `${name} is there already; choose another name.`);
    const about = { text, base: isGone ? null : base, ...(isHosts ? {} : { name }) };
    const slow = setTimeout(
      () => say("Nothing is saved yet: Studio does not answer.", "warning"), SLOW);
    try {
      const answer = await connection.request<Saved>("studio/save", about);
      if (answer.ok) this.saved(scene, name, text);
      // The file was changed by another program. If the page shows another scene by now, the user
      // cannot choose between the page's and the file's text, so the save fails.
      else if (this.current !== scene)
        throw new Refusal(0, `${name} is not saved: it was changed.`);
      else if (answer.text === null) this.changed(null);
      else this.ask(answer.text);
    } catch (error) {
      // A restarted host does not know the files that it created before, so Save asks for a name.
      scene.isNew ||= scene !== hostScene && error instanceof Refusal && error.code !== 0;
      throw error instanceof Refusal ? error : new Error(NOT_SAVED);
    } finally { clearTimeout(slow); }
  }

  private saved(scene: Scene, name: string, text: string): void {
    scene.seen = scene.base = text;
    Object.assign(scene, { name, isGone: false, isNew: false, untouched: null });
    if (scene.of === this.current) this.current = this.current.copy = scene;
    // If the host has no file yet, the saved scene becomes the host's.
    if (this.hostScene.isNew) [this.hostScene, this.pendingHostFile] = [scene, null];
    say(`${visibleLine(name)} is saved.`);
    this.onSaved(text);
  }

  /** Asks for the name of a new file and saves it. The dialog stays open until saving succeeds. */
  private askName(scene: Scene): void {
    const dialog = byId<HTMLDialogElement>("name-dialog");
    const field = byId<HTMLInputElement>("name-field");
    const problem = byId("name-problem");
    setText(problem, "");
    field.value = scene.name;
    byId("name-form").onsubmit = async event => {
      if ((event.submitter as HTMLButtonElement | null)?.value === "") return;
      event.preventDefault();
      const name = field.value.trim();
      try {
        if (name === "") throw new Error("A file needs a name.");
        await this.saveAs(scene, name.endsWith(".scn") ? name : `${name}.scn`);
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

  private async saveLocal(scene: Scene): Promise<void> {
    const { textToSave: text } = this;
    const about = { ...SCENES, suggestedName: scene.name };
    scene.handle ??= (await pickers.showSaveFilePicker?.(about)) ?? null;
    if (scene.handle === null) download(scene.name, text, "text/plain");
    else {
      // The browser writes to a copy. When the copy is closed, it replaces the file.
      const file = await scene.handle.createWritable();
      await file.write(text);
      await file.close();
    }
    this.saved(scene, scene.handle?.name ?? scene.name, text);
  }

  private async open(): Promise<void> {
    if (isServed || pickers.showOpenFilePicker === undefined) return byId("file").click();
    const [handle] = await pickers.showOpenFilePicker(SCENES);
    if (handle !== undefined) await this.take(await handle.getFile(), handle);
  }

  private async take(file: File, handle: FileSystemFileHandle | null): Promise<void> {
    try {
      // Invalid UTF-8 is refused, since Save would change a text in another encoding.
      const text = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true })
        .decode(await file.arrayBuffer());
      const scene = new Scene(file.name);
      scene.handle = handle;
      if (!isServed) scene.seen = scene.base = text;
      this.replaceBy(text, scene);
      this.tellLone();
    } catch { say(`${visibleLine(file.name)} is no text in UTF-8.`, "warning"); }
    this.show();
  }

  /** Shows the differences between the page's text and the file's text, and asks which of the two
   * to keep. Undo restores the page's text. */
  private ask(theirs: string): void {
    const lines = difference(withLf(theirs), editor.text)
      .map(({ sign, text }) => create("div", CLASSES[sign], `${sign} ${text}`));
    byId("conflict-lines").replaceChildren(...lines);
    setText(byId("conflict-name"), this.shownName);
    this.conflict.returnValue = "";
    this.conflict.onclose = () => {
      const { returnValue: choice } = this.conflict;
      // If the user closes the dialog without a choice, `base` is not changed. It then differs from
      // the file, so the next save asks again.
      if (choice === "") return;
      this.current.seen = this.current.base = theirs;
      if (choice === "page") void this.save();
      else editor.replace(theirs);
      this.show();
    };
    if (!this.conflict.open) this.conflict.showModal();
  }
}

/** Returns `text` with the line ends of `file`. A line that is not in `file` gets the line end of
 * the line before it. */
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

/** Compares two texts. Returns the lines from the first to the last difference, and up to two more
 * lines before and after them. */
export function difference(one: string, other: string): DifferenceLine[] {
  const lines = compared(one.split("\n"), other.split("\n"));
  const differs = ({ sign }: DifferenceLine) => sign !== " ";
  return lines.slice(Math.max(0, lines.findIndex(differs) - 2), lines.findLastIndex(differs) + 3);
}

/** Compares lines. The sign is `-` for lines only in `a`, `+` only in `b`, else a space. */
function compared(a: string[], b: string[]): DifferenceLine[] {
  const parts = diffArrays(a, b, { maxEditLength: MOST_CHANGES })
    ?? [{ value: a, removed: true, added: false }, { value: b, removed: false, added: true }];
  return parts.flatMap(({ value, added, removed }) =>
    value.map((text): DifferenceLine => ({ sign: added ? "+" : removed ? "-" : " ", text })));
}

export const files = new Files();
