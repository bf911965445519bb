// Documents and text editors of the substitute for VS Code. They join edits to steps for Undo as VS
// Code does.

/** A text document. It reports each change by calling `tell`. */
export class Document {
  version = 1;
  isDirty = false;
  isClosed = false;
  languageId = "pinhole";
  /** Texts that Undo restores, from the oldest to the newest. */
  steps = [];
  saves = 0;
  isInStep = false;
  tell = () => {};

  constructor(uri, text) {
    Object.assign(this, { uri, fileName: uri.fsPath, text });
  }

  getText(range) {
    return range === undefined ? this.text : this.text.slice(this.offsetAt(range.start), this.offsetAt(range.end));
  }

  offsetAt({ line, character }) {
    const lines = this.text.split("\n");
    return lines.slice(0, line).reduce((sum, it) => sum + it.length + 1, 0) + Math.min(character, lines[line].length);
  }

  positionAt(offset) {
    const lines = this.text.slice(0, offset).split("\n");
    return { line: lines.length - 1, character: lines.at(-1).length };
  }

  /** Returns the word at a position, or undefined. */
  getWordRangeAtPosition(position) {
    const at = this.offsetAt(position);
    for (const { index, 0: word } of this.text.matchAll(/\w+/g)) {
      if (index <= at && at <= index + word.length) return { start: this.positionAt(index), end: this.positionAt(index + word.length) };
    }
    return undefined;
  }

  async save() {
    this.saves++;
    this.isDirty = false;
    return true;
  }

  /** Applies edits as one step for Undo, or as a part of the step before. */
  apply(edits, { undoStopBefore = true, undoStopAfter = true } = {}) {
    if (undoStopBefore) this.isInStep = false;
    if (!this.isInStep) this.steps.push(this.text);
    this.isInStep = !undoStopAfter;
    this.change(edits);
  }

  /** Replaces the last occurrence of `old` by `text`, as if a user typed it. */
  type(old, text) {
    const at = this.text.lastIndexOf(old);
    if (at < 0) throw new Error(`${old} is not in the text`);
    this.apply([{ range: { start: this.positionAt(at), end: this.positionAt(at + old.length) }, text }]);
  }

  undo() {
    const text = this.steps.pop();
    this.isInStep = false;
    if (text !== undefined) this.change([{ range: { start: { line: 0, character: 0 }, end: this.positionAt(this.text.length) }, text }]);
  }

  change(edits) {
    const end = this.text.endsWith("\r\n") || this.text.includes("\r\n") ? "\r\n" : "\n";
    const changes = edits
      .map(({ range, text }) => ({ range, text: text.replace(/\r?\n/g, end), rangeOffset: this.offsetAt(range.start), rangeLength: this.getText(range).length }))
      .sort((a, b) => b.rangeOffset - a.rangeOffset);
    for (const { rangeOffset, rangeLength, text } of changes) {
      this.text = this.text.slice(0, rangeOffset) + text + this.text.slice(rangeOffset + rangeLength);
    }
    this.version++;
    this.isDirty = true;
    this.tell({ document: this, contentChanges: changes, reason: undefined });
  }
}

/** An editor that shows a document. As in VS Code, its edits are applied a little later. They fail
 * if the text has changed before. */
export class TextEditor {
  selection;
  revealed = [];

  constructor(document, viewColumn) {
    Object.assign(this, { document, viewColumn });
  }

  async edit(build, options) {
    const { document, document: { version } } = this;
    const edits = [];
    build({ replace: (range, text) => edits.push({ range, text }) });
    await new Promise(resolve => setTimeout(resolve, 2));
    if (document.version !== version) return false;
    document.apply(edits, options);
    return true;
  }

  revealRange(range) { this.revealed.push(range); }
}
