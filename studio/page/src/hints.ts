// What the editor shows between the letters: values that the server works out, and a swatch before each colour, which opens a picker.

import { StateEffect, StateField, type Range as DecorationRange } from "@codemirror/state";
import { Decoration, EditorView, WidgetType, type DecorationSet } from "@codemirror/view";
import type { Connection } from "./connection";
import { create } from "./dom";
import type { SceneEditor } from "./editor";
import { Gesture } from "./gesture";
import { isSuperseded, type Position, type Range, type TextEdit } from "./protocol";

interface InlayHint {
  position: Position;
  label: string;
}

interface Color {
  red: number;
  green: number;
  blue: number;
  alpha: number;
}

interface ColorInformation {
  range: Range;
  color: Color;
}

/** How long the text has to rest before hints are asked for, in milliseconds. */
const REST = 150;

const setHints = StateEffect.define<DecorationSet>();

export const hintField = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(hints, transaction) {
    let next = hints.map(transaction.changes);
    for (const effect of transaction.effects) if (effect.is(setHints)) next = effect.value;
    return next;
  },
  provide: field => EditorView.decorations.from(field),
});

class HintWidget extends WidgetType {
  constructor(private readonly text: string) {
    super();
  }

  override eq(other: HintWidget): boolean {
    return other.text === this.text;
  }

  toDOM(): HTMLElement {
    return create("span", "hint", this.text);
  }
}

class SwatchWidget extends WidgetType {
  constructor(private readonly hints: Hints, private readonly color: string, private readonly written: string) {
    super();
  }

  override eq(other: SwatchWidget): boolean {
    return other.color === this.color && other.written === this.written;
  }

  toDOM(view: EditorView): HTMLElement {
    const input = create("input", "swatch");
    input.type = "color";
    let gesture: Gesture | null = null;
    let wanted: string | null = null;
    let work = Promise.resolve();
    input.addEventListener("input", () => {
      const going = (gesture ??= new Gesture(view));
      wanted = input.value;
      // One after the other, and of those that wait the newest alone.
      work = work.then(async () => {
        const color = wanted;
        wanted = null;
        if (color !== null) await this.hints.pick(view.posAtDOM(input), color, going);
      });
    });
    input.addEventListener("change", () => {
      const going = gesture;
      gesture = null;
      void work.then(() => going?.end());
    });
    this.updateDOM(input);
    return input;
  }

  // The picker belongs to the element: that stays while the colour changes.
  override updateDOM(dom: HTMLElement): boolean {
    const input = dom as HTMLInputElement;
    input.value = this.color;
    input.setAttribute("aria-label", `Colour ${this.written}`);
    return true;
  }

  override ignoreEvent(): boolean {
    return true;
  }
}

export class Hints {
  private timer = 0;
  private swatches: { from: number; to: number; color: string }[] = [];

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection) {}

  /** The text has changed: new hints come when it rests. */
  changed(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.refresh(), REST);
  }

  private async refresh(): Promise<void> {
    const { editor } = this;
    const { doc } = editor.view.state;
    if (editor.uri === "") return;
    const range = { start: { line: 0, character: 0 }, end: { line: doc.lines, character: 0 } };
    try {
      const [hints, colors] = await Promise.all([
        this.connection.request<InlayHint[] | null>("textDocument/inlayHint", editor.about({ range })),
        this.connection.request<ColorInformation[] | null>("textDocument/documentColor", editor.about({})),
      ]);
      if (editor.view.state.doc !== doc) return;
      this.swatches = (colors ?? []).map(({ range, color }) => ({ from: editor.offset(range.start), to: editor.offset(range.end), color: hex(color) }));
      const decorations: DecorationRange<Decoration>[] = [
        ...(hints ?? []).map(({ position, label }) => Decoration.widget({ widget: new HintWidget(label), side: 1 }).range(editor.offset(position))),
        ...this.swatches.map(({ from, to, color }) => Decoration.widget({ widget: new SwatchWidget(this, color, doc.sliceString(from, to)), side: -1 }).range(from)),
      ];
      editor.view.dispatch({ effects: setHints.of(Decoration.set(decorations, true)) });
    } catch (error) {
      // Hints are not worth a message: a newer text or connection brings new ones.
      if (!isSuperseded(error)) console.warn(error);
    }
  }

  /** Writes a picked colour in place of the one that begins at an offset, in the way it is written there. */
  async pick(offset: number, picked: string, gesture: Gesture): Promise<void> {
    const { editor } = this;
    const { doc } = editor.view.state;
    const written = /^(?:#[\da-fA-F]+|rgb\s*\([^)]*\)|\w+)/.exec(doc.sliceString(offset, offset + 200))?.[0] ?? "";
    const line = doc.lineAt(offset);
    const start = { line: line.number - 1, character: offset - line.from };
    const channel = (at: number) => parseInt(picked.slice(at, at + 2), 16) / 255;
    const color = { red: channel(1), green: channel(3), blue: channel(5), alpha: 1 };
    const range = { start, end: { line: start.line, character: start.character + written.length } };
    try {
      const ways = await this.connection.request<{ label: string; textEdit?: TextEdit }[]>("textDocument/colorPresentation", editor.about({ color, range }));
      const way = ways.find(({ label }) => label.startsWith("rgb") === written.startsWith("rgb")) ?? ways[0];
      if (way?.textEdit !== undefined && editor.view.state.doc === doc) gesture.apply(editor.changes([way.textEdit]));
    } catch (error) {
      if (!isSuperseded(error)) console.warn(error);
    }
  }
}

function hex({ red, green, blue }: Color): string {
  return `#${[red, green, blue].map(it => Math.round(it * 255).toString(16).padStart(2, "0")).join("")}`;
}
