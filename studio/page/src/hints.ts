// Additions shown in the text: values that the server has computed, and a swatch at each colour.

import { StateEffect, StateField, type Text } from "@codemirror/state";
import { Decoration, EditorView, WidgetType, type Command,
  type DecorationSet } from "@codemirror/view";
import type { Color, ColorInformation, ColorPresentation, InlayHint } from
  "vscode-languageserver-protocol";
import { create, newestOf } from "./dom";
import { editor } from "./editor";
import { Gesture } from "./gesture";

/** Matches a colour at the start of a text: a code, a call of `rgb`, or a name. */
const COLOR = /^(?:#[\da-fA-F]+|rgb\s*\([^)]*\)|\w+)/;
const colorAt = (doc: Text, at: number) => COLOR.exec(doc.sliceString(at, at + 200))?.[0] ?? "";
const setHints = StateEffect.define<DecorationSet>();

export const hintField = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update: (hints, { changes, effects }) =>
    effects.findLast(it => it.is(setHints))?.value ?? hints.map(changes),
  provide: field => EditorView.decorations.from(field),
});

class HintWidget extends WidgetType {
  constructor(private readonly text: string) { super(); }
  override eq(other: HintWidget): boolean { return other.text === this.text; }
  toDOM(): HTMLElement { return create("span", "hint", this.text); }
  // A click on the hint sets the cursor, as a click on the text would.
  override ignoreEvent(): boolean { return false; }
}

class SwatchWidget extends WidgetType {
  constructor(private readonly color: string, private readonly written: string) { super(); }

  override eq(other: SwatchWidget): boolean {
    return other.color === this.color && other.written === this.written;
  }

  toDOM(view: EditorView): HTMLElement {
    const input = create("input", "swatch");
    input.type = "color";
    // The Tab key skips swatches. Alt-Enter opens the swatch of the colour at the cursor.
    input.tabIndex = -1;
    let gesture: Gesture | null = null;
    let work = Promise.resolve();
    const write = newestOf((color: string) =>
      pick(view.posAtDOM(input), color, (gesture ??= new Gesture(view))));
    input.addEventListener("input", () => (work = write(input.value)));
    input.addEventListener("change", () => void work.then(() => {
      gesture?.end();
      gesture = null;
    }));
    this.updateDOM(input);
    return input;
  }

  // The element stays when the colour changes, because an open colour picker belongs to it.
  override updateDOM(dom: HTMLElement): boolean {
    const input = dom as HTMLInputElement;
    input.value = this.color;
    input.setAttribute("aria-label", `Colour ${this.written}`);
    return true;
  }

  override ignoreEvent(): boolean { return true; }
}

/** Opens the colour picker at the cursor. Returns whether there is a colour at the cursor. */
export const openSwatch: Command = view => {
  const { state: { doc, selection: { main } }, dom } = view;
  const swatch = [...dom.querySelectorAll<HTMLInputElement>(".swatch")].find(it => {
    const at = view.posAtDOM(it);
    return at <= main.head && main.head <= at + colorAt(doc, at).length;
  });
  swatch?.focus();
  swatch?.showPicker();
  return swatch !== undefined;
};

/** Requests the hints and colours of the current text. It is called after a pause in changes. */
export async function refreshHints(): Promise<void> {
  const { doc } = editor.view.state;
  const [hints, colors] = await Promise.all([
    editor.askCurrent<InlayHint[]>("textDocument/inlayHint", { range: editor.range() }),
    editor.askCurrent<ColorInformation[]>("textDocument/documentColor", {}),
  ]);
  if (hints === null || colors === null) return; // a newer text or connection brings new ones
  const decorations = [
    ...hints.map(({ position, label }) =>
      Decoration.widget({ widget: new HintWidget(String(label)), side: 1 })
      .range(editor.offset(position))),
    ...colors.map(({ range, color }) => {
      const from = editor.offset(range.start);
      const widget = new SwatchWidget(hex(color), doc.sliceString(from, editor.offset(range.end)));
      return Decoration.widget({ widget, side: -1 }).range(from);
    }),
  ];
  editor.view.dispatch({ effects: setHints.of(Decoration.set(decorations, true)) });
}

/** Replaces the colour at `offset` by `picked` (`#rrggbb`), spelled in the old colour's form. */
async function pick(offset: number, picked: string, gesture: Gesture): Promise<void> {
  const written = colorAt(gesture.base, offset);
  const channel = (at: number) => parseInt(picked.slice(at, at + 2), 16) / 255;
  const color = { red: channel(1), green: channel(3), blue: channel(5), alpha: 1 };
  const { length } = colorAt(editor.view.state.doc, offset);
  const range = editor.range(offset, offset + length);
  const ways = await editor.askCurrent<ColorPresentation[]>(
    "textDocument/colorPresentation", { color, range });
  // The server lists the forms in which the new colour can be written. The first one is the form of
  // the old colour, so it is used.
  const way = ways?.[0];
  if (way !== undefined) gesture.write({ from: offset, to: offset + written.length,
    insert: way.label });
}

function hex({ red, green, blue }: Color): string {
  const channel = (value: number) => Math.round(value * 255).toString(16).padStart(2, "0");
  return `#${[red, green, blue].map(channel).join("")}`;
}
