// Changes of a number in the text, by a drag with the Alt key or by a slider below the number.

import { syntaxTree } from "@codemirror/language";
import { StateEffect, StateField, type Extension } from "@codemirror/state";
import { EditorView, keymap, showTooltip, type TooltipView } from "@codemirror/view";
import { create, createButton, followPointer } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { Gesture } from "./gesture";
import { NUMBER } from "./language";
import type { Limits } from "./protocol";

/** A number in the text, from its sign at `from` to `to`. Its unit, if any, reaches to `end`. */
export interface Literal { from: number; to: number; end: number; value: number }

/** Pixels by which the pointer moves sideways to change the number by one step. With fewer pixels,
 * single steps would be hard to hit; with more, a drag would not reach far. */
const DRAG_PIXELS = 4;

/** Matches the text before a number if it ends with the number's sign `-`. It does not match if the
 * `-` is a subtraction. */
const SIGN = /(?:^|[-+*/=(,{]|\b(?:y|roll|spin))\s*-$/;

export function literalAt(at: number): Literal | null {
  const { state } = editor.view;
  const node = [-1, 1].map(side => syntaxTree(state).resolveInner(at, side as -1 | 1))
    .find(it => it.name === "number");
  if (node === undefined) return null;
  const written = NUMBER.exec(state.sliceDoc(node.from, node.to))?.[0];
  if (written === undefined) return null;
  const line = state.doc.lineAt(node.from);
  const before = state.sliceDoc(line.from, node.from);
  const isNegative = SIGN.test(before);
  const value = Number(written.replaceAll("_", "")) * (isNegative ? -1 : 1);
  return { from: node.from - (isNegative ? 1 : 0), to: node.from + written.length,
    end: node.to, value };
}

/** Requests the limits of the number at an offset; null if there is no number. */
function limitsOf(at: number): Promise<Limits | null> {
  return editor.ask("pinhole/limits", { position: editor.position(at) });
}

/** Returns a value as it is written in the text: rounded, and clamped to the number's limits. */
export function written({ least, most, decimals }: Limits, value: number): string {
  const right = Math.min(most ?? Infinity, Math.max(least ?? -Infinity, value));
  // Adding 0 turns −0 into 0, so that no minus sign is written before a zero.
  return String(Number(right.toFixed(decimals)) + 0);
}

/** Changes a number within its limits, so that a single Undo reverts all the changes. */
export class NumberEdit {
  readonly gesture = new Gesture(editor.view);

  constructor(private readonly literal: Literal, private readonly limits = limitsOf(literal.to)) {}

  /** Sets the number to the value that `value` returns, rounded and clamped to the number's limits.
   * `value` gets the number's step. */
  async set(value: (step: number) => number): Promise<void> {
    const { from, to } = this.literal;
    const limits = await this.limits;
    if (limits === null) return;
    this.gesture.write({ from, to, insert: written(limits, value(limits.step)) });
  }

  end(): void { void this.limits.then(() => this.gesture.end()); }
}

/** Slider of a number in the text. One Undo reverts all changes until the slider is released. */
export class NumberSlider {
  readonly range = create("input");
  turn: NumberEdit | null = null;
  limits: Limits | null = null;

  constructor(readonly literal: () => Literal | null) {
    const { range } = this;
    range.type = "range";
    // After Escape, the browser still moves the slider until the pointer is released. While `isOff`
    // is set, these movements do not change the number.
    let isOff = false;
    range.addEventListener("input", () => isOff ? this.show() : void this.set(Number(range.value)));
    range.addEventListener("change", () => this.end());
    range.addEventListener("pointerdown", event => followPointer(event, () => {}, () => {}, () => {
      isOff = true;
      addEventListener("pointerup", () => (isOff = false), { once: true, capture: true });
      this.turn?.gesture.cancel();
      this.end();
      this.show();
    }));
  }

  async set(value: number): Promise<void> {
    const found = this.literal();
    const limits = this.limits === null ? undefined : Promise.resolve(this.limits);
    if (found !== null) this.turn ??= new NumberEdit(found, limits);
    frames.dragging ??= this;
    await this.turn?.set(() => value);
  }

  end(): void {
    this.turn?.end();
    this.turn = null;
    frames.released(this);
  }

  /** Moves the slider to the value of the number in the text, unless the user is moving the slider.
   * Returns the number's place and value; null if the number was deleted. */
  show(): Literal | null {
    const found = this.literal();
    if (found === null || this.turn !== null || this.limits === null) return found;
    const { ends: [min, max], step } = this.limits;
    Object.assign(this.range, { min, max, step, value: found.value });
    return found;
  }
}

const openSlider = StateEffect.define<number | null>();

/** Offset of the number whose slider is open; null if no slider is open. */
const sliderField = StateField.define<number | null>({
  create: () => null,
  update(open, transaction) {
    const { changes, docChanged, effects, selection } = transaction;
    const next = effects.findLast(it => it.is(openSlider));
    if (next !== undefined) return next.value;
    // Typing or moving the cursor closes the slider. Changes by the slider itself do not.
    const isTyped = docChanged && transaction.isUserEvent("input");
    return open === null || isTyped || selection !== undefined ? null : changes.mapPos(open, -1);
  },
  provide: field => showTooltip.from(field, pos =>
    pos === null ? null : { pos, create: createSlider, strictSide: false }),
});

const show = (pos: number | null) => editor.view.dispatch({ effects: openSlider.of(pos) });

/** Limits of the number whose slider was opened last. */
let opened: Limits | null = null;

/** Requests the limits of the number at `at`. If the cursor is still there, opens its slider. */
async function open(at: number): Promise<void> {
  opened = await limitsOf(at + 1);
  if (opened !== null && atCursor()?.from === at) show(at);
}

function createSlider(): TooltipView {
  const dom = create("div", "slider");
  const dial = new NumberSlider(() => literalAt((editor.view.state.field(sliderField) ?? 0) + 1));
  const { range, literal } = dial;
  const adapt = () => range.setAttribute("aria-label", `Value ${dial.show()?.value ?? ""}`);
  range.addEventListener("keydown", event => {
    if (event.key !== "Escape" && event.key !== "Enter") return;
    event.preventDefault();
    show(null);
    editor.view.focus();
  });
  const less = createButton("−", "", () => stepOnce(literal(), -1), "Less");
  const more = createButton("+", "", () => stepOnce(literal(), 1), "More");
  const grip = create("span", "grip", "↔ drag");
  grip.title = "Drag to the side; in the text, drag a number with the Alt key";
  grip.addEventListener("pointerdown", event => dragNumber(event, literal()));
  dom.append(less, range, more, grip);
  const refresh = async () => {
    const found = literal();
    if (found !== null) dial.limits = await limitsOf(found.to) ?? dial.limits;
    adapt();
  };
  dial.limits = opened;
  return { dom, mount: adapt, update({ docChanged }) {
    if (docChanged) adapt();
    if (docChanged && dial.turn === null) void refresh();
  } };
}

/** Changes `literal` while the pointer moves sideways. Returns false if `literal` is null. */
function dragNumber(event: PointerEvent, literal: Literal | null): boolean {
  if (literal === null) return false;
  event.preventDefault();
  const turn = new NumberEdit(literal);
  document.body.classList.add("scrubbing");
  const move = (next: PointerEvent) => void turn.set(step =>
    literal.value + Math.round((next.clientX - event.clientX) / DRAG_PIXELS) * step);
  const over = (act: () => void) => () => {
    document.body.classList.remove("scrubbing");
    act();
  };
  followPointer(event, move, over(() => turn.end()), over(() => turn.gesture.cancel()));
  return true;
}

/** Changes `literal` by one step up (1) or down (−1). Returns false if `literal` is null. */
function stepOnce(literal: Literal | null, direction: number): boolean {
  if (literal === null) return false;
  const turn = new NumberEdit(literal);
  void turn.set(step => literal.value + direction * step);
  turn.end();
  return true;
}

const atCursor = () => literalAt(editor.view.state.selection.main.head);

export const numberControls: Extension = [
  sliderField,
  EditorView.domEventHandlers({
    pointerdown(event, view) {
      if (!event.altKey || event.button !== 0) return false;
      const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
      return dragNumber(event, at === null ? null : literalAt(at));
    },
    // While the Alt key is held, a drag changes a number, so a press must not begin a selection.
    mousedown: event => event.altKey,
    click({ altKey }, { state }) {
      const literal = state.selection.main.empty && !altKey ? atCursor() : null;
      if (literal !== null) void open(literal.from);
      return false;
    },
  }),
  keymap.of([
    // If there is no number at the cursor, these keys keep their usual function.
    { key: "Alt-ArrowUp", run: () => stepOnce(atCursor(), 1) },
    { key: "Alt-ArrowDown", run: () => stepOnce(atCursor(), -1) },
    { key: "Alt-Enter", run: ({ dom }) => {
      const literal = atCursor();
      if (literal === null) return false;
      void open(literal.from).then(() => requestAnimationFrame(() =>
        dom.querySelector<HTMLInputElement>(".slider input")?.focus()));
      return true;
    } },
    { key: "Escape", run: ({ state }) => {
      if (state.field(sliderField) === null) return false;
      show(null);
      return true;
    } },
  ]),
];
