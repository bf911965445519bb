// Numbers in the text that one can turn: by a drag with the alt key, and by a slider below them.

import { syntaxTree } from "@codemirror/language";
import { StateEffect, StateField, type Extension } from "@codemirror/state";
import { EditorView, keymap, showTooltip, type TooltipView } from "@codemirror/view";
import { create, createButton, followPointer } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { Gesture } from "./gesture";
import { NUMBER } from "./language";
import type { Limits } from "./protocol";

/** A number literal, with the sign that belongs to it, and where its unit ends. */
interface Literal { from: number; to: number; end: number; value: number; written: string }

/** So many screen pixels of a drag are one step. */
const DRAG_PIXELS = 4;

/** Bounds so far apart leave nothing to turn on a slider, as those of a seed. */
const FAR = 1e6;
/** A minus sign that belongs to the number, since it has nothing to subtract from. */
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
    end: node.to, value, written };
}

/** A hundredth to a tenth of the number, no less than 0.01, and no coarser than it is written. */
function stepOf({ value, written }: Literal, limits: Limits | null): number {
  if (limits?.step) return limits.step;
  const [, fraction = "", power = "0"] = /^[^.e]*(?:\.([\d_]*))?(?:e(.*))?$/i.exec(written) ?? [];
  const lastDigit = Number(power) - fraction.replaceAll("_", "").length;
  const exponent = Math.max(Math.floor(Math.log10(Math.abs(value) || 1)) - 1, -2);
  return 10 ** (lastDigit < 0 ? Math.min(exponent, lastDigit) : exponent);
}

export function format(value: number, step: number): string {
  // A step of 0.25 has two decimals, one of 1e-7 seven.
  const [, fraction = "", power = "0"] = /^\d+(?:\.(\d+))?(?:e(.*))?$/
    .exec(String(Number(step.toPrecision(12)))) ?? [];
  const decimals = Math.max(0, fraction.length - Number(power));
  return String(Number(value.toFixed(Math.min(decimals, 100))) + 0); // no minus before a zero
}

/** Says between which numbers the one at an offset may be; null if nobody knows. */
function limitsOf(at: number): Promise<Limits | null> {
  return editor.ask("pinhole/limits", { position: editor.position(at) });
}

/** The least and the greatest value that a number can be turned to. */
function bounds(step: number, limits: Limits | null): [number, number] {
  const margin = limits?.open ? step : 0;
  return [(limits?.least ?? -Infinity) + margin, (limits?.most ?? Infinity) - margin];
}

/** The same for a slider: about the value that is there, unless both bounds are known and near. */
function offered(value: number, step: number, limits: Limits | null): [number, number] {
  const span = Math.max(Math.abs(value), 50 * step);
  const [least, most] = bounds(step, limits);
  if (limits?.open === false && most - least < FAR) return [least, most];
  return [Math.max(least, value - span), Math.min(most, value + span)];
}

/** Turns one number through a gesture, as far as its limits allow, which the server knows. */
export class Turn {
  readonly gesture = new Gesture(editor.view);

  constructor(private readonly literal: Literal, private readonly limits = limitsOf(literal.to)) {}

  /** The value may depend on the step. */
  async set(value: (step: number) => number): Promise<void> {
    const { literal, literal: { from, to } } = this;
    const limits = await this.limits;
    const step = stepOf(literal, limits);
    const [least, most] = bounds(step, limits);
    const insert = format(Math.min(most, Math.max(least, value(step))), step);
    this.gesture.write({ from, to, insert });
  }

  end(): void { void this.limits.then(() => this.gesture.end()); }
}

/** A slider of a number, which may be gone. What it does until it is let go is one turn. */
export class Dial {
  readonly range = create("input");
  turn: Turn | null = null;
  limits: Limits | null = null;

  constructor(readonly literal: () => Literal | null) {
    const { range } = this;
    range.type = "range";
    // After Escape the browser goes on with its drag until the pointer is let go.
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
    if (found !== null) this.turn ??= new Turn(found, limits);
    frames.dragging ??= this;
    await this.turn?.set(() => value);
  }

  end(): void {
    this.turn?.end();
    this.turn = null;
    frames.released(this);
  }

  /** Shows the number between the ends that its limits leave, unless a hand holds it. */
  show(): Literal | null {
    const found = this.literal();
    if (found === null || this.turn !== null) return found;
    const { value } = found;
    const step = stepOf(found, this.limits);
    const [min, max] = offered(value, step, this.limits);
    Object.assign(this.range, { min, max, step, value });
    return found;
  }
}

const openSlider = StateEffect.define<number | null>();

/** Where the number begins whose slider is open. */
const sliderField = StateField.define<number | null>({
  create: () => null,
  update(open, transaction) {
    const { changes, docChanged, effects, selection } = transaction;
    const next = effects.findLast(it => it.is(openSlider));
    if (next !== undefined) return next.value;
    // Typing closes it; what the slider itself writes does not.
    const isTyped = docChanged && transaction.isUserEvent("input");
    return open === null || isTyped || selection !== undefined ? null : changes.mapPos(open, -1);
  },
  provide: field => showTooltip.from(field, pos =>
    pos === null ? null : { pos, create: createSlider, strictSide: false }),
});

const show = (pos: number | null) => editor.view.dispatch({ effects: openSlider.of(pos) });

function createSlider({ state }: EditorView): TooltipView {
  const dom = create("div", "slider");
  const dial = new Dial(() => literalAt((editor.view.state.field(sliderField) ?? 0) + 1));
  const { range, literal } = dial;
  const adapt = () => range.setAttribute("aria-label", `Value ${dial.show()?.value ?? ""}`);
  range.addEventListener("keydown", event => {
    if (event.key !== "Escape" && event.key !== "Enter") return;
    event.preventDefault();
    show(null);
    editor.view.focus();
  });
  const less = createButton("−", "", () => turnOnce(literal(), -1), "Less");
  const more = createButton("+", "", () => turnOnce(literal(), 1), "More");
  const grip = create("span", "grip", "↔");
  grip.title = "Drag to the side; in the text, drag a number with the Alt key";
  grip.addEventListener("pointerdown", event => scrub(event, literal()));
  dom.append(less, range, more, grip);
  void limitsOf((state.field(sliderField) ?? 0) + 1).then(found => {
    dial.limits = found;
    adapt();
  });
  return { dom, mount: adapt, update: ({ docChanged }) => { if (docChanged) adapt(); } };
}

/** Turns a number by the way of the pointer to the side, until it is let go. */
function scrub(event: PointerEvent, literal: Literal | null): boolean {
  if (literal === null) return false;
  event.preventDefault();
  const turn = new Turn(literal);
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

/** Turns a number by a step. Says whether there is one. */
function turnOnce(literal: Literal | null, direction: number): boolean {
  if (literal === null) return false;
  const turn = new Turn(literal);
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
      return scrub(event, at === null ? null : literalAt(at));
    },
    // With the alt key the editor would begin to select.
    mousedown: event => event.altKey,
    click({ altKey }, { state }) {
      const literal = state.selection.main.empty && !altKey ? atCursor() : null;
      if (literal !== null) show(literal.from);
      return false;
    },
  }),
  keymap.of([
    // Elsewhere than at a number these do what they do without.
    { key: "Alt-ArrowUp", run: () => turnOnce(atCursor(), 1) },
    { key: "Alt-ArrowDown", run: () => turnOnce(atCursor(), -1) },
    { key: "Alt-Enter", run: ({ dom }) => {
      const literal = atCursor();
      if (literal === null) return false;
      show(literal.from);
      requestAnimationFrame(() => dom.querySelector<HTMLInputElement>(".slider input")?.focus());
      return true;
    } },
    { key: "Escape", run: ({ state }) => {
      if (state.field(sliderField) === null) return false;
      show(null);
      return true;
    } },
  ]),
];
