// The numbers and angles that a `let` is, each with a slider; one of them may be played to and fro.

import type { ChangeDesc } from "@codemirror/state";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { Dial, literalAt } from "./numbers";
import type { Slider } from "./protocol";
import { setText } from "./visible";

/** How long it takes to play a number from one end to the other, in milliseconds. */
const PLAY = 4000;

/** A definition's row, where its number begins in the text, and the step that is chosen for it. */
interface Row {
  name: string;
  at: number;
  step: number | null;
  dial: Dial;
  element: HTMLElement;
  value: HTMLElement;
  button: HTMLButtonElement;
}

let rows: Row[] = [];
let playing: Row | null = null;

/** The text has changed: each slider follows its number. */
export function mapSliders(changes: ChangeDesc): void {
  for (const row of rows) {
    row.at = changes.mapPos(row.at, -1);
    show(row);
  }
}

function show({ dial, value }: Row): void {
  const found = dial.literal();
  if (found === null) return;
  setText(value, editor.view.state.sliceDoc(found.from, found.end));
  if (dial.turn === null) dial.range.value = String(found.value);
}

/** The text has come to rest: sliders are those of its definitions. */
export async function refreshSliders(): Promise<void> {
  const sliders = await editor.askCurrent<Slider[]>("pinhole/sliders", {});
  // A hand that turns one keeps it.
  if (sliders === null || rows.some(row => row.dial.turn)) return;
  if (sliders.some(({ name }, i) => rows[i]?.name !== name) || sliders.length < rows.length) {
    rows = sliders.map(({ name }) => createRow(name));
    byId("sliders").replaceChildren(...rows.map(row => row.element));
  }
  byId("sliders").hidden = sliders.length === 0;
  sliders.forEach(({ range, limits, step }, i) => {
    const row = rows[i] as Row;
    Object.assign(row, { at: editor.offset(range.start), step });
    const found = row.dial.literal();
    if (found !== null) row.dial.offer(found, limits);
    show(row);
  });
}

function createRow(name: string): Row {
  const dial = new Dial(() => {
    const found = literalAt(row.at + 1);
    return found && { ...found, step: row.step ?? found.step };
  });
  dial.range.setAttribute("aria-label", name);
  dial.range.addEventListener("input", () => {
    if (playing === row) stop();
    frames.dragging ??= dial;
  });
  dial.range.addEventListener("change", () => end(row));
  const [element, value] = [create("div", "slider-row"), create("output")];
  const button = createButton("", "", () => play(row));
  element.append(create("span", "", name), dial.range, value, button);
  const row: Row = { name, at: 0, step: null, dial, element, value, button };
  label(row, "▶", "Play");
  return row;
}

function end({ dial }: Row): void {
  dial.end();
  frames.released(dial);
}

function stop(): void {
  const row = playing;
  playing = null;
  if (row === null) return;
  label(row, "▶", "Play");
  end(row);
}

/** Moves a number to and fro until it is stopped; it begins where it is. */
function play(row: Row): void {
  const isNew = playing !== row;
  stop();
  if (!isNew) return;
  playing = row;
  label(row, "⏸", "Stop");
  const { dial, dial: { range } } = row;
  const [least, most] = [Number(range.min), Number(range.max)];
  const begin = performance.now() - PLAY * (Number(range.value) - least) / (most - least);
  const go = async () => {
    if (playing !== row) return;
    const part = ((performance.now() - begin) / PLAY) % 2;
    range.value = String(least + (most - least) * (part > 1 ? 2 - part : part));
    frames.dragging ??= dial;
    await dial.set(Number(range.value));
    await frames.coarse;
    // Whoever changes the number otherwise, or undoes that, has it rest.
    if (dial.turn === null || dial.turn.isOver) stop();
    else requestAnimationFrame(() => void go());
  };
  void go();
}

/** What a row's button shows, and what it does. */
function label({ name, button }: Row, sign: string, does: string): void {
  setText(button, sign);
  button.setAttribute("aria-label", `${does} ${name}`);
}
