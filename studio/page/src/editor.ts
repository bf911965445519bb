// The text editor: CodeMirror, with the language server's features through its language client.

import { closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, historyKeymap, toggleComment } from "@codemirror/commands";
import { bracketMatching } from "@codemirror/language";
import { lintGutter, nextDiagnostic, previousDiagnostic } from "@codemirror/lint";
import { formatKeymap, hoverTooltips, jumpToDefinitionKeymap, LSPClient, renameKeymap,
  serverCompletion, signatureHelp } from "@codemirror/lsp-client";
import { diff } from "@codemirror/merge";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { ChangeSet, EditorState, Prec, StateEffect, type ChangeSpec,
  type Extension, type SelectionRange, type Text } from "@codemirror/state";
import { drawSelection, dropCursor, EditorView, highlightActiveLine, highlightActiveLineGutter,
  highlightSpecialChars, keymap, lineNumbers, tooltips, type ViewUpdate } from "@codemirror/view";
import type { Position, Range, TextEdit } from "vscode-languageserver-protocol";
import { connection } from "./connection";
import { byId, meta } from "./dom";
import { gestureHistory, rewrite } from "./gesture";
import { sceneHighlighting, sceneLanguage } from "./language";
import { isSuperseded } from "./protocol";
import { sanitized } from "./sanitize";

/** Time limit for comparing texts, in ms. After this time, the rest is compared less finely. A much
 * longer time would be felt as a pause. */
const DIFF_TIME = 100;

/** Matches unpaired surrogates. UTF-8, the encoding of files and messages, cannot contain them. */
const HALVES = /\p{Surrogate}/gu;

/** Replaces typed or pasted unpaired surrogates by U+FFFD, the replacement character. */
const wholeCharacters = EditorState.transactionFilter.of(transaction => {
  const changes: ChangeSpec[] = [];
  transaction.changes.iterChanges((_fromA, _toA, from, _toB, inserted) => {
    for (const { index } of inserted.toString().matchAll(HALVES)) changes.push(
      { from: from + index, to: from + index + 1, insert: "\ufffd" });
  });
  return changes.length === 0 ? transaction : [transaction, { changes, sequential: true }];
});

/** Inserts typed text itself, not through the browser, if the typed text or the selection spans
 * several lines. In these cases, the browser would add inline styles, which the page's content
 * security policy forbids. */
const replacedLines = EditorView.domEventHandlers({
  beforeinput({ inputType, data, isComposing }, view) {
    const { state } = view;
    const { from, to } = state.selection.main;
    if (inputType !== "insertText" || data === null || isComposing) return false;
    if (!data.includes("\n") && to <= state.doc.lineAt(from).to) return false;
    const insert = () => state.update(state.replaceSelection(data),
      { userEvent: "input.type", scrollIntoView: true });
    const handlers = state.facet(EditorView.inputHandler);
    if (!handlers.some(handle => handle(view, from, to, data, insert))) view.dispatch(insert());
    return true;
  },
});

/** Makes a typed `}` replace the existing closing brace of the block around the cursor. Does so
 * only if nothing but white space lies between the cursor and that brace. */
const closingBrace = Prec.high(EditorView.inputHandler.of((view, from, to, typed) => {
  const { doc } = view.state;
  const space = typed === "}" ? /^\s*(?=\})/.exec(doc.sliceString(to, doc.length))?.[0] : undefined;
  const before = doc.sliceString(0, from).replace(/\/\/.*|\/\*[^]*?\*\//g, "");
  if (space === undefined || before.lastIndexOf("{") <= before.lastIndexOf("}")) return false;
  const line = doc.lineAt(from);
  const start = /^\s*$/.test(doc.sliceString(line.from, from)) ? line.from : from;
  const end = to + space.length;
  view.dispatch({ changes: { from: start, to: end }, selection: { anchor: start + 1 },
    scrollIntoView: true, userEvent: "input.type" });
  return true;
}));

/** If the editor does not have the focus, scrolls the editor's text to the position `head`.
 * CodeMirror's default would also scroll the page. */
function withinText(view: EditorView, { head }: SelectionRange): boolean {
  if (view.hasFocus) return false;
  const { scrollDOM, documentPadding } = view;
  const { top, bottom } = view.lineBlockAt(head);
  const least = bottom + documentPadding.top - scrollDOM.clientHeight;
  scrollDOM.scrollTop = Math.max(least, Math.min(scrollDOM.scrollTop, top));
  return true;
}

/** Returns `text` with LF as its line ends, which the editor uses. */
export function withLf(text: string): string {
  return text.includes("\r") ? text.replace(/\r\n?/g, "\n") : text;
}

/** Language client that drops hover answers about an outdated text. */
class SceneClient extends LSPClient {
  override async request<Params, Result>(method: string, params: Params): Promise<Result> {
    const { doc } = editor.view.state;
    const answer = await super.request<Params, Result>(method, params);
    const isLate = method === "textDocument/hover" && editor.view.state.doc !== doc;
    return isLate ? null as Result : answer;
  }
}

class SceneEditor {
  readonly view: EditorView;
  readonly client: LSPClient;
  /** URI of the scene at the server; empty until the scene is opened there. */
  uri = "";
  onNotification: (method: string, params: any) => void = () => {};
  onUpdate: (update: ViewUpdate) => void = () => {};

  constructor(parent: HTMLElement, nonce: string | undefined) {
    this.client = new SceneClient({
      // Time after which a request fails, in ms. It is long, because a busy machine may answer
      // slowly. A lost connection is noticed earlier, by `connection`.
      timeout: 60_000,
      sanitizeHTML: sanitized,
      unhandledNotification: (_, method, params) => this.onNotification(method, params),
      extensions: [serverCompletion(), hoverTooltips(), signatureHelp()],
    });
    connection.ready = () => this.client.initializing;
    this.view = new EditorView({
      parent,
      extensions: [
        nonce === undefined ? [] : EditorView.cspNonce.of(nonce),
        // The text cannot be edited before the scene has arrived, because the scene replaces it.
        EditorState.readOnly.of(true),
        wholeCharacters,
        lineNumbers(), lintGutter(), highlightActiveLine(), highlightActiveLineGutter(),
        highlightSpecialChars(), highlightSelectionMatches(), drawSelection(), dropCursor(),
        // Tooltips must not cover the tools above the text.
        tooltips({ tooltipSpace: ({ dom }) => ({ left: 0, right: innerWidth, bottom: innerHeight,
          top: dom.getBoundingClientRect().top }) }),
        EditorView.scrollHandler.of(withinText),
        bracketMatching(), closeBrackets(), closingBrace, replacedLines, gestureHistory(),
        sceneLanguage, sceneHighlighting, EditorView.lineWrapping,
        EditorView.contentAttributes.of({ "aria-label": "Text of the scene", tabindex: "0",
          spellcheck: "false", autocapitalize: "off" }),
        keymap.of([
          ...formatKeymap, ...renameKeymap, ...jumpToDefinitionKeymap,
          { key: "Mod-/", run: toggleComment },
          ...closeBracketsKeymap, ...completionKeymap,
          { key: "F8", run: nextDiagnostic, shift: previousDiagnostic },
          ...searchKeymap, ...historyKeymap, ...defaultKeymap,
        ]),
        EditorView.updateListener.of(it => {
          // Without a connection, the change is sent after the page has connected again.
          if (it.docChanged && connection.state === "open") this.client.sync();
          this.onUpdate(it);
        }),
      ],
    });
  }

  /** Adds an extension from another module, with precedence over the editor's own ones. */
  extend(extension: Extension): void {
    this.view.dispatch({ effects: StateEffect.appendConfig.of(Prec.high(extension)) });
  }

  /** The text, with LF line ends. */
  get text(): string { return this.view.state.doc.toString(); }

  /** Sends a request about the scene. Rejects if it fails, or if there is no connection. */
  request<Result>(method: string, params: object): Promise<Result> {
    return connection.request(method, { textDocument: { uri: this.uri }, ...params });
  }

  /** Sends a request about the scene. Resolves to null if the request fails. The server also
   * answers some requests with null if the text has errors. */
  async ask<Result>(method: string, params: object): Promise<Result | null> {
    try {
      return await this.request<Result | null>(method, params);
    } catch (error) {
      if (!isSuperseded(error) && connection.state === "open") console.warn(error);
      return null;
    }
  }

  /** Sends a request about the scene. Resolves to null if the request fails, or if the text has
   * errors or is changed before the answer arrives. */
  async askCurrent<Result>(method: string, params: object): Promise<Result | null> {
    const { doc } = this.view.state;
    const answer = await this.ask<Result>(method, params);
    return this.view.state.doc === doc ? answer : null;
  }

  /** Returns the LSP range from offset `from` to `to`; by default, the range of the whole text. */
  range(from = 0, to = this.view.state.doc.length): Range {
    return { start: this.position(from), end: this.position(to) };
  }

  /** Replaces the text and its undo history. With the default, an empty history, Undo cannot remove
   * the new text. */
  open(text: string, past: Extension = []): void {
    const changes = { from: 0, to: this.view.state.doc.length, insert: text };
    rewrite(this.view, { changes, selection: { anchor: 0 } }, past);
  }

  /** Opens another text at the server under the URI `uri`, without showing it in the editor. */
  openAside(uri: string, doc: Text): void {
    const file = { uri, languageId: "pinhole", version: 0, doc, getView: () => null };
    if (connection.state === "open") this.client.didOpen(file);
  }

  closeAside(uri: string): void { if (connection.state === "open") this.client.didClose(uri); }

  /** Opens the scene at the server and makes the editor writable. Does so only once. */
  start(): void {
    if (this.uri !== "") return;
    this.uri = "studio:///scene.scn";
    this.view.dispatch({ effects: StateEffect.appendConfig.of([
      Prec.highest(EditorState.readOnly.of(false)), this.client.plugin(this.uri, "pinhole")]) });
  }

  /** Replaces the text by changing only what differs, so that the cursor stays. An insertion or
   * deletion starts at the beginning of a line if the result is the same. For example, a new block
   * that begins like the next block is inserted as whole lines. */
  replace(content: string): void {
    const [old, text] = [this.text, withLf(content)];
    let end = 0;
    const changes = diff(old, text, { timeout: DIFF_TIME }).map(({ fromA, toA, fromB, toB }) => {
      const isPure = fromA === toA || fromB === toB;
      const last = (back: number) => fromA === toA ? text[toB - back] : old[toA - back];
      const line = Math.max(end, old.lastIndexOf("\n", fromA - 1) + 1);
      let back = fromA - line;
      for (let i = 1; i <= back; i++) if (!isPure || old[fromA - i] !== last(i)) back = 0;
      end = toA - back;
      return { from: fromA - back, to: end, insert: text.slice(fromB - back, toB - back) };
    });
    if (old !== text) this.view.dispatch({ changes, userEvent: "input.replace" });
  }

  /** Connects the language client to a new server, which does not have the text yet. */
  connected(): void {
    this.client.workspace.syncFiles();
    this.client.connect(connection);
  }

  offset({ line, character }: Position, doc = this.view.state.doc): number {
    if (line >= doc.lines) return doc.length;
    const { from, to } = doc.line(line + 1);
    return Math.min(from + character, to);
  }

  position(offset: number): Position {
    const line = this.view.state.doc.lineAt(offset);
    return { line: line.number - 1, character: offset - line.from };
  }

  /** Converts LSP edits of `doc`, by default the scene's text, to changes of the editor. */
  changes(edits: readonly TextEdit[], doc = this.view.state.doc): ChangeSet {
    const change = ({ range: { start, end }, newText }: TextEdit) =>
      ({ from: this.offset(start, doc), to: this.offset(end, doc), insert: newText });
    return ChangeSet.of(edits.map(change), doc.length, "\n");
  }
}

export const editor = new SceneEditor(byId("editor"), meta("nonce"));
