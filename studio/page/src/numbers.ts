// Numbers in the text that one can turn: a drag to the side with the alt key, and a slider that
// opens below a number on a click or by Alt-Enter.

import { syntaxTree } from "@codemirror/language";
import { Facet, StateEffect, StateField, type EditorState,
  type Extension } from "@codemirror/state";
import { EditorView, keymap, showTooltip, type Command, type Tooltip,
  type TooltipView } from "@codemirror/view";
import { create, createButton, followPointer } from "./dom";
import { Gesture } from "./gesture";
import { endsInWholeField, NUMBER } from "./language";
import type { Limits } from "./protocol";

/** A number literal, with the sign that belongs to it. */
interface Literal { from: number; to: number; value: number; step: number }

/** So many screen pixels of a drag are one step. */
const DRAG_PIXELS = 4;

/** A minus sign that belongs to the number, since it has nothing to subtract from. */
const SIGN = /(?:^|[-+*/=(,{]|\b(?:y|roll|spin))\s*-$/;

function literalAt(state: EditorState, at: number): Literal | null {
  const node = [-1, 1].map(side => syntaxTree(state).resolveInner(at, side as -1 | 1))
    .find(it => it.name === "number");
  if (node === undefined) return null;
  const written = NUMBER.exec(state.sliceDoc(node.from, node.to))?.[0];
  if (written === undefined) return null;
  const line = state.doc.lineAt(node.from);
  const before = state.sliceDoc(line.from, node.from);
  const isNegative = SIGN.test(before);
  const value = Number(written.replaceAll("_", "")) * (isNegative ? -1 : 1);
  return { from: node.from - (isNegative ? 1 : 0), to: node.from + written.length, value,
    step: stepOf(value, written, endsInWholeField(before)) };
}

/** A hundredth to a tenth of the number, but no less than a hundredth, so that a way to zero
 *  ends; and no coarser than how it is written. */
function stepOf(value: number, written: string, isWhole: boolean): number {
  if (isWhole) return 1;
  const [, fraction = "", power = "0"] = /^[^.e]*(?:\.([\d_]*))?(?:e(.*))?$/i.exec(written) ?? [];
  const lastDigit = Number(power) - fraction.replaceAll("_", "").length;
  const exponent = Math.max(Math.floor(Math.log10(Math.abs(value) || 1)) - 1, -2);
  return 10 ** (lastDigit < 0 ? Math.min(exponent, lastDigit) : exponent);
}

function format(value: number, step: number): string {
  const decimals = Math.max(0, Math.round(-Math.log10(step)));
  const rounded = Number(value.toFixed(Math.min(decimals, 100)));
  return String(Object.is(rounded, -0) ? 0 : rounded);
}

/** Says between which numbers the one at a place of the text may be; null if nobody knows. */
const limitSource = Facet.define<(at: number) => Promise<Limits | null>>();

async function limitsOf({ state }: EditorView, literal: Literal): Promise<Limits | null> {
  return (await state.facet(limitSource)[0]?.(literal.to)) ?? null;
}

/** The least and the greatest value that a number can be turned to. */
function bounds({ step }: Literal, limits: Limits | null): [number, number] {
  const margin = limits?.open ? step : 0;
  return [(limits?.least ?? -Infinity) + margin, (limits?.most ?? Infinity) - margin];
}

/** Turns one number through a gesture, as far as its limits allow, which the server knows. */
class Turn {
  private readonly gesture: Gesture;
  private to: number;
  private written: string;
  private readonly bounds: Promise<[number, number]>;
  private wanted = 0;

  constructor(private readonly view: EditorView, private readonly literal: Literal) {
    this.gesture = new Gesture(view);
    this.to = literal.to;
    this.written = view.state.sliceDoc(literal.from, literal.to);
    this.bounds = limitsOf(view, literal).then(limits => bounds(literal, limits));
  }

  async set(value: number): Promise<void> {
    const { from, step } = this.literal;
    this.wanted = value;
    const [least, most] = await this.bounds;
    const text = format(Math.min(most, Math.max(least, this.wanted)), step);
    const now = this.view.state.sliceDoc(from, this.to);
    // Whoever has changed the number otherwise keeps it.
    if (text === now || now !== this.written) return;
    this.gesture.apply({ from, to: this.to, insert: text });
    this.to = from + text.length;
    this.written = text;
  }

  end(): void { void this.bounds.then(() => this.gesture.end()); }
}

const openSlider = StateEffect.define<number | null>();

const sliderField = StateField.define<Tooltip | null>({
  create: () => null,
  update(tooltip, transaction) {
    let next = tooltip;
    // Typing closes it; what the slider itself writes does not.
    if (next !== null && transaction.docChanged) next = transaction.isUserEvent("input") ? null
      : { ...next, pos: transaction.changes.mapPos(next.pos, -1) };
    if (next !== null && transaction.selection !== undefined) next = null;
    for (const effect of transaction.effects) {
      if (!effect.is(openSlider)) continue;
      const pos = effect.value;
      next = pos === null ? null : { pos, create: createSlider, strictSide: false };
    }
    return next;
  },
  provide: field => showTooltip.from(field),
});

function createSlider(view: EditorView): TooltipView {
  const dom = create("div", "slider");
  const range = create("input");
  range.type = "range";
  let turn: Turn | null = null;
  let shown: number | null = null;
  const literal = () => literalAt(view.state, (view.state.field(sliderField)?.pos ?? 0) + 1);
  const adapt = () => {
    const found = literal();
    if (found === null || turn !== null || found.value === shown) return;
    const span = Math.max(Math.abs(found.value), 50 * found.step);
    const offer = (limits: Limits | null) => {
      const [least, most] = bounds(found, limits);
      range.min = String(Math.max(least, found.value - span));
      range.max = String(Math.min(most, found.value + span));
      range.step = String(found.step);
      range.value = String(found.value);
    };
    range.setAttribute("aria-label", `Value ${found.value}`);
    shown = found.value;
    offer(null);
    const isStill = () => found.value === shown && turn === null;
    void limitsOf(view, found).then(limits => isStill() && offer(limits));
  };
  range.addEventListener("input", () => {
    const found = literal();
    if (found !== null) turn ??= new Turn(view, found);
    void turn?.set(Number(range.value));
  });
  range.addEventListener("change", () => {
    turn?.end();
    turn = null;
  });
  range.addEventListener("keydown", event => {
    if (event.key !== "Escape" && event.key !== "Enter") return;
    event.preventDefault();
    view.dispatch({ effects: openSlider.of(null) });
    view.focus();
  });
  const less = createButton("−", "", () => turnOnce(view, literal(), -1));
  less.setAttribute("aria-label", "Less");
  const more = createButton("+", "", () => turnOnce(view, literal(), 1));
  more.setAttribute("aria-label", "More");
  const grip = create("span", "grip", "↔");
  grip.title = "Drag to the side; in the text, drag a number with the Alt key";
  grip.addEventListener("pointerdown", event => {
    const found = literal();
    if (found !== null) scrub(event, view, found);
  });
  dom.append(less, range, more, grip);
  return { dom, mount: adapt, update: ({ docChanged }) => { if (docChanged) adapt(); } };
}

/** Turns a number by the way of the pointer to the side, until it is let go. */
function scrub(event: PointerEvent, view: EditorView, literal: Literal): void {
  event.preventDefault();
  const turn = new Turn(view, literal);
  document.body.classList.add("scrubbing");
  const move = (next: PointerEvent) => void turn.set(
    literal.value + Math.round((next.clientX - event.clientX) / DRAG_PIXELS) * literal.step);
  followPointer(event, move, () => {
    document.body.classList.remove("scrubbing");
    turn.end();
  });
}

/** Turns a number by a step. Says whether there is one. */
function turnOnce(view: EditorView, literal: Literal | null, direction: number): boolean {
  if (literal === null) return false;
  const turn = new Turn(view, literal);
  void turn.set(literal.value + direction * literal.step);
  turn.end();
  return true;
}

/** Turns the number at the cursor; elsewhere the key does what it does without. */
function turnBy(direction: number): Command {
  return view => turnOnce(view, literalAt(view.state, view.state.selection.main.head), direction);
}

const openAtCursor: Command = view => {
  const literal = literalAt(view.state, view.state.selection.main.head);
  if (literal === null) return false;
  view.dispatch({ effects: openSlider.of(literal.from) });
  requestAnimationFrame(() => view.dom.querySelector<HTMLInputElement>(".slider input")?.focus());
  return true;
};

export function numberControls(limits: (at: number) => Promise<Limits | null>): Extension {
  return [
    limitSource.of(limits),
    sliderField,
    EditorView.domEventHandlers({
      pointerdown(event, view) {
        if (!event.altKey || event.button !== 0) return false;
        const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
        const literal = at === null ? null : literalAt(view.state, at);
        if (literal === null) return false;
        scrub(event, view, literal);
        return true;
      },
      // With the alt key the editor would begin to select.
      mousedown: event => event.altKey,
      click(event, view) {
        const { main } = view.state.selection;
        const literal = main.empty && !event.altKey ? literalAt(view.state, main.head) : null;
        if (literal !== null) view.dispatch({ effects: openSlider.of(literal.from) });
        return false;
      },
    }),
    keymap.of([
      { key: "Alt-ArrowUp", run: turnBy(1) },
      { key: "Alt-ArrowDown", run: turnBy(-1) },
      { key: "Alt-Enter", run: openAtCursor },
      { key: "Escape", run: view => {
        if (view.state.field(sliderField) === null) return false;
        view.dispatch({ effects: openSlider.of(null) });
        return true;
      } },
    ]),
  ];
}
