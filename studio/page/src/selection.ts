// What is selected: the object that the cursor is in. It has handles over the picture, and is named
// in the menu of all objects.

import type { ChangeDesc } from "@codemirror/state";
import { byId, createButton, create } from "./dom";
import type { Held } from "./drag";
import type { SceneEditor } from "./editor";
import type { OverlayLayer } from "./overlays";
import type { Picture } from "./picture";
import type { DrawnObject, Handle, Point, SceneObject } from "./protocol";

/** The least distance of two targets, in screen pixels, to the side or in height. */
const APART = matchMedia("(pointer: coarse)").matches ? 45 : 25;

/** Where a handle goes, from where it is, if that place is taken: the nearest first. */
const ASIDE: Point[] = [];
for (let x = -60; x <= 60; x += 6) for (let y = -60; y <= 60; y += 6) ASIDE.push([x, y]);
ASIDE.sort((a, b) => Math.hypot(...a) - Math.hypot(...b));

/** An object, and its block's place in the text, which follows changes. */
interface Placed { object: SceneObject; from: number; to: number }

export function nameOf(object: SceneObject): string { return object.name ?? object.kind; }

export class Selection {
  /** The index of the object that is selected. */
  index: number | null = null;
  onChange: () => void = () => {};
  private placed: Placed[] = [];
  /** Whether the object at the cursor is not to be selected, until the cursor moves. */
  private deselected = false;
  private readonly handles = byId("handles");
  private readonly menu = byId<HTMLSelectElement>("objects");

  constructor(private readonly editor: SceneEditor, private readonly picture: Picture,
    private readonly overlays: OverlayLayer) {
    this.menu.addEventListener("change", () => {
      const chosen = this.placed.find(it => String(it.object.index) === this.menu.value);
      this.select(chosen?.object ?? null);
    });
  }

  list(objects: readonly SceneObject[]): void {
    this.placed = objects.map(object => this.place(object));
    const names = objects.map(it =>
      it.name === null ? `${it.kind} (${it.range.start.line + 1})` : `${it.name} (${it.kind})`);
    const shown = [...this.menu.options].slice(1);
    if (names.length !== shown.length || names.some((name, i) => name !== shown[i]?.text)) {
      const options = objects.map((object, i) => new Option(names[i], String(object.index)));
      this.menu.replaceChildren(new Option("Nothing selected", ""), ...options);
    }
    this.follow();
  }

  /** The text has changed: blocks are elsewhere, until the objects of the new text are known. */
  mapped(changes: ChangeDesc): void {
    for (const it of this.placed) {
      it.from = changes.mapPos(it.from, 1);
      it.to = Math.max(it.from, changes.mapPos(it.to, -1));
    }
    this.follow();
  }

  /** Selects the object that the cursor has been moved into. */
  cursorMoved(): void {
    this.deselected = false;
    this.follow();
  }

  /** Selects an object and shows its line; nothing for null. */
  select(object: SceneObject | null): void {
    this.deselected = object === null;
    if (object === null) return this.follow();
    // The list has the first objects alone.
    const isListed = this.placed.some(it => it.object.index === object.index);
    if (!isListed) this.placed.push(this.place(object));
    this.editor.jump(object.selection.start);
    this.cursorMoved();
  }

  private place(object: SceneObject): Placed {
    const { start, end } = object.range;
    return { object, from: this.editor.offset(start), to: this.editor.offset(end) };
  }

  private follow(): void {
    const { head } = this.editor.view.state.selection.main;
    const touching = this.placed.filter(it => it.from < it.to && it.from <= head && head <= it.to);
    // At the border of two it is the second one.
    const found = this.deselected ? undefined : touching.find(it => head < it.to) ?? touching[0];
    const index = found?.object.index ?? null;
    this.menu.value = index === null ? "" : String(index);
    if (index === this.index) return;
    this.index = index;
    this.overlays.select(index);
    this.draw();
    this.onChange();
  }

  /** The selected object as it is drawn; none while that is not known of this text. */
  get drawn(): DrawnObject | undefined {
    const { data, isTrue } = this.overlays;
    return isTrue ? data?.objects.find(it => it.index === this.index) : undefined;
  }

  /** Puts the handles of the selected object where they are seen. */
  draw(): void {
    const object = this.drawn;
    const shown = (object?.handles ?? []).filter(it => it.at !== null);
    const old = [...this.handles.children] as HTMLButtonElement[];
    const same = old.length === shown.length && old.every((button, i) =>
      button.dataset["handle"] === shown[i]?.handle
      && button.dataset["object"] === String(object?.index));
    const buttons = same ? old
      : shown.map(handle => this.createHandle(object as DrawnObject, handle));
    if (!same) this.handles.replaceChildren(...buttons);
    const taken: Point[] = [];
    shown.forEach(({ at }, i) => {
      const [x, y] = apart(this.picture.toScreen(at as Point), taken);
      taken.push([x, y]);
      const button = buttons[i] as HTMLButtonElement;
      button.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    });
  }

  private createHandle(object: DrawnObject, { handle, label }: Handle): HTMLButtonElement {
    const button = createButton("", "handle", () => {});
    button.dataset["handle"] = handle;
    button.dataset["object"] = String(object.index);
    button.setAttribute("aria-label", `${nameOf(object)}: ${label}`);
    button.append(create("span", "handle-label", label));
    return button;
  }

  /** The handle of the selected object that an element stands for; its first one for null. */
  held(element: Element | null): Held | null {
    const name = element?.closest<HTMLElement>(".handle")?.dataset["handle"];
    const object = this.drawn;
    const handle = name === undefined ? object?.handles[0]
      : object?.handles.find(it => it.handle === name);
    if (object === undefined || !handle?.at) return null;
    return { object: object.index, handle: handle.handle, at: handle.at };
  }
}

/** Where a handle is put that would lie on others: beside them. */
function apart([x, y]: Point, taken: readonly Point[]): Point {
  const isFree = ([x, y]: Point) =>
    taken.every(it => Math.max(Math.abs(x - it[0]), Math.abs(y - it[1])) >= APART);
  return ASIDE.map(([dx, dy]): Point => [x + dx, y + dy]).find(isFree) ?? [x, y];
}
