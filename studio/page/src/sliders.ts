// The numbers and angles that a `let` is, each with a slider; one of them may be played to and fro.

import type { ChangeDesc } from "@codemirror/state";
import { byId, create, createButton } from "./dom";
import type { SceneEditor } from "./editor";
import type { Frames } from "./frames";
import { literalAt, offered, Turn, type Literal } from "./numbers";
import type { Slider } from "./protocol";
import { setText } from "./visible";

/** How long the text has to rest before its definitions are asked for, and how long it takes to
 *  play a number from one end to the other, in milliseconds. */
const REST = 150;
const PLAY = 4000;

/** A definition's row, and where its number begins in the text. */
interface Row {
  name: string;
  at: number;
  bounds: [number, number];
  step: number | null;
  unit: string;
  element: HTMLElement;
  range: HTMLInputElement;
  value: HTMLElement;
  play: HTMLButtonElement;
  turn: Turn | null;
}

export class Sliders {
  private rows: Row[] = [];
  private timer = 0;
  private playing: Row | null = null;
  private readonly panel = byId("sliders");

  constructor(private readonly editor: SceneEditor, private readonly frames: Frames,
    private readonly rested: () => void) {}

  /** The text has changed: sliders are those of its definitions when it rests. */
  changed(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.refresh(), REST);
  }

  mapped(changes: ChangeDesc): void {
    for (const row of this.rows) row.at = changes.mapPos(row.at, -1);
  }

  private literal(row: Row): Literal | null {
    return literalAt(this.editor.view.state, row.at + 1);
  }

  private async refresh(): Promise<void> {
    const { editor, rows } = this;
    const { doc } = editor.view.state;
    const sliders = editor.uri === "" ? [] : await editor.ask<Slider[]>("pinhole/sliders", {});
    // A hand that turns one keeps it.
    if (sliders === null || editor.view.state.doc !== doc || rows.some(row => row.turn)) return;
    if (sliders.some(({ name }, i) => rows[i]?.name !== name) || sliders.length < rows.length) {
      this.rows = sliders.map(({ name }) => this.createRow(name));
      this.panel.replaceChildren(...this.rows.map(row => row.element));
    }
    this.panel.hidden = sliders.length === 0;
    sliders.forEach(({ range, limits, step }, i) => {
      const row = this.rows[i] as Row;
      row.at = editor.offset(range.start);
      const literal = this.literal(row);
      if (literal === null) return;
      const { least, most } = limits;
      // Within bounds that were chosen nothing is left out.
      const chosen = step !== null || (least !== null && most !== null);
      row.bounds = chosen && least !== null && most !== null && !limits.open ? [least, most]
        : offered(literal, limits);
      const [min, max] = row.bounds;
      row.step = step ?? literal.step;
      Object.assign(row.range, { min, max, step: row.step, value: literal.value });
      row.unit = doc.sliceString(literal.to, editor.offset(range.end)).trim();
      setText(row.value, doc.sliceString(row.at, literal.to) + row.unit);
    });
  }

  private createRow(name: string): Row {
    const element = create("div", "slider-row");
    const range = create("input");
    range.type = "range";
    range.setAttribute("aria-label", name);
    const value = create("output");
    const play = createButton("▶", "", () => this.play(row));
    play.setAttribute("aria-label", `Play ${name}`);
    element.append(create("span", "", name), range, value, play);
    const row: Row = { name, at: 0, bounds: [0, 1], step: null, unit: "", turn: null,
      element, range, value, play };
    range.addEventListener("input", () => {
      if (this.playing === row) this.stop();
      void this.set(row, Number(range.value));
    });
    range.addEventListener("change", () => this.end(row));
    return row;
  }

  private async set(row: Row, to: number): Promise<void> {
    const { view } = this.editor;
    const literal = this.literal(row);
    if (literal === null) return this.end(row);
    row.turn ??= new Turn(view, { ...literal, step: row.step ?? literal.step });
    this.frames.dragging ??= row;
    await row.turn.set(to);
    const now = this.literal(row);
    if (now !== null) setText(row.value, view.state.sliceDoc(now.from, now.to) + row.unit);
  }

  private end(row: Row): void {
    row.turn?.end();
    row.turn = null;
    if (this.frames.dragging === row) this.frames.dragging = null;
    this.rested();
  }

  private stop(): void {
    const row = this.playing;
    this.playing = null;
    if (row === null) return;
    setText(row.play, "▶");
    row.play.setAttribute("aria-label", `Play ${row.name}`);
    this.end(row);
  }

  /** Moves a number to and fro until it is stopped; it begins where it is. */
  private play(row: Row): void {
    const isNew = this.playing !== row;
    this.stop();
    if (!isNew) return;
    this.playing = row;
    setText(row.play, "⏸");
    row.play.setAttribute("aria-label", `Stop ${row.name}`);
    const [least, most] = row.bounds;
    const begin = performance.now() - PLAY * (Number(row.range.value) - least) / (most - least);
    const go = async () => {
      if (this.playing !== row) return;
      const part = ((performance.now() - begin) / PLAY) % 2;
      row.range.value = String(least + (most - least) * (part > 1 ? 2 - part : part));
      await this.set(row, Number(row.range.value));
      await this.frames.coarse;
      // Whoever changes the number otherwise, or undoes that, has it rest.
      if (row.turn === null || row.turn.isOver) this.stop();
      else requestAnimationFrame(() => void go());
    };
    void go();
  }
}
