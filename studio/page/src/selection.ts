// The selection: the object in whose block the cursor is. Its handles are drawn over the picture.
// The menu lists all objects. This module also adds, duplicates and deletes objects.

import { isolateHistory } from "@codemirror/commands";
import type { ChangeDesc } from "@codemirror/state";
import { byId, createButton, create } from "./dom";
import type { Held } from "./drag";
import { editor } from "./editor";
import { overlays } from "./overlays";
import { picture, type Picture } from "./picture";
import { tools } from "./tools";
import type { Added, DrawnObject, Handle, Point, SceneObject } from "./protocol";
import { say } from "./status";
import { setText } from "./visible";

/** Offsets from a handle's point, in screen pixels, the nearest first. A handle that would overlap
 * another one is moved by the first offset that avoids the overlap. */
const OFFSETS: Point[] = [];
for (let x = -60; x <= 60; x += 6) for (let y = -60; y <= 60; y += 6) OFFSETS.push([x, y]);
OFFSETS.sort((a, b) => Math.hypot(...a) - Math.hypot(...b));

/** An object with its block's range in the text, which follows changes of the text. */
interface Placed { object: SceneObject; from: number; to: number }

class Selection {
  /** The selected object; undefined if none is selected. */
  selected: Placed | undefined;
  onChange: () => void = () => {};
  /** Number of selections made so far. If it has grown when the server answers, the user has
   * selected something else in the meantime. */
  selectionCount = 0;
  private placed: Placed[] = [];
  /** Object that the user has chosen; null if the user chose to select nothing; undefined before
   * any choice. It is stored because a loop may create several objects from one block, and the
   * cursor does not tell which of them is meant. */
  private chosen: SceneObject | null | undefined;
  private readonly handles = byId("handles");
  private readonly menu = byId<HTMLSelectElement>("objects");

  constructor() {
    this.menu.addEventListener("change", () => {
      const chosen = this.placed.find(it => String(it.object.index) === this.menu.value);
      this.select(chosen?.object ?? null);
    });
  }

  list(objects: readonly SceneObject[]): void {
    this.placed = objects.map(object => this.place(object));
    this.name();
    this.follow();
  }

  private name(): void {
    const options = this.placed.map(({ object: { index, label, name, kind, range } }) =>
      new Option(`${label} (${name === null ? range.start.line + 1 : kind})`, String(index)));
    const shown = [...this.menu.options].slice(1);
    const isShown = (it: HTMLOptionElement, i: number) => it.isEqualNode(shown[i] ?? null);
    if (options.length === shown.length && options.every(isShown)) return;
    this.menu.replaceChildren(new Option("No object", ""), ...options);
  }

  /** Adapts the blocks' ranges to a change, until the objects of the new text are known. */
  mapped(changes: ChangeDesc): void {
    for (const it of this.placed) {
      it.from = changes.mapPos(it.from, 1);
      it.to = Math.max(it.from, changes.mapPos(it.to, -1));
    }
    this.follow();
  }

  /** Selects the object into whose block the cursor was moved. */
  cursorMoved(): void {
    this.selectionCount++;
    if (this.chosen === null) this.chosen = undefined;
    this.follow(true);
  }

  /** Selects an object and scrolls to its block. If `object` is null, selects nothing. */
  select(object: SceneObject | null): void {
    this.selectionCount++;
    this.chosen = object;
    if (object === null) return this.follow();
    // The server lists only a limited number of objects. If this one is not listed, it is added
    // here.
    const isListed = this.placed.some(it => it.object.index === object.index);
    if (!isListed) this.placed.push(this.place(object));
    this.name();
    const anchor = editor.offset(object.selection.start);
    editor.view.dispatch({ selection: { anchor }, scrollIntoView: true });
    this.cursorMoved();
  }

  private place(object: SceneObject): Placed {
    const { start, end } = object.range;
    return { object, from: editor.offset(start), to: editor.offset(end) };
  }

  /** Selects the object at the cursor. Unless `isByCursor` is set, an object that is already
   * selected stays selected wherever the cursor is. */
  private follow(isByCursor = false): void {
    const { head } = editor.view.state.selection.main;
    const there = this.placed.filter(it => it.from < it.to);
    const { from = 0, to = 0 } = this.selected ?? {};
    const kept = isByCursor || from === to ? [] : there.filter(it => it.from === from);
    const touching = kept.length > 0 ? kept : there.filter(it => it.from <= head && head <= it.to);
    // If the cursor is between two adjacent blocks, the second block is used. If a loop creates
    // several objects from the block, the one that the user has chosen before is selected, or else
    // the first.
    const first = touching.find(it => head < it.to) ?? touching[0];
    const isChosen = ({ from, object: { indices } }: Placed) => from === first?.from
      && String(indices) === String(this.chosen?.indices);
    const found = this.chosen === null ? undefined : touching.find(isChosen) ?? first;
    if (this.chosen !== null) this.chosen = found?.object;
    const before = this.index;
    this.selected = found;
    this.menu.value = String(this.index ?? "");
    this.offer();
    if (this.index === before) return;
    overlays.selected = this.index;
    overlays.draw();
    this.draw();
    this.onChange();
  }

  get index(): number | null { return this.selected?.object.index ?? null; }

  private offer(): void {
    const none = this.index === null;
    for (const id of ["duplicate", "delete"]) byId<HTMLButtonElement>(id).disabled = none;
    const hasFloor = this.placed.some(it => it.object.kind === "checkerboard");
    tools.offer(this.index !== null, hasFloor);
  }

  /** Outline and handles of the selected object; undefined if they are not known for the current
   * text. */
  get drawn(): DrawnObject | undefined {
    const { data, isCurrent: isTrue } = overlays;
    const { line } = editor.position(this.selected?.from ?? 0);
    // The line is compared as well as the index: until the objects of a new text are listed, the
    // index may belong to another object.
    return isTrue ? data?.objects.find(it => it.index === this.index
      && it.range.start.line === line) : undefined;
  }

  /** Places the handles of the selected object over the picture. */
  draw(): void {
    const object = this.drawn;
    placeHandles(this.handles, picture, object === undefined ? [] : handlesOf(object));
  }

  /** Returns the handle of the selected object that `element` shows. If `element` is null, returns
   * the object's first handle. */
  held(element: Element | null): Held | null {
    const name = element?.closest<HTMLElement>(".handle")?.dataset["handle"];
    const object = this.drawn;
    const handle = name === undefined ? object?.handles[0]
      : object?.handles.find(it => it.handle === name);
    if (object === undefined || !handle?.at) return null;
    return { object: object.index, handle: handle.handle, at: handle.at };
  }
}

/** A handle with the object that it belongs to. `object` is null if it belongs to the camera. */
export interface OwnedHandle extends Handle { object: number | null; owner: string }

export function handlesOf({ index, label, handles }: DrawnObject): OwnedHandle[] {
  return handles.map(it => ({ ...it, object: index, owner: label }));
}

/** Places buttons for the visible handles over the picture `where`. */
export function placeHandles(parent: HTMLElement, where: Picture,
  handles: readonly OwnedHandle[]): void {
  const shown = handles.filter(it => it.at !== null);
  const names = JSON.stringify(shown.map(it => [it.object, it.handle]));
  // Replacing the buttons would end a drag of one of them, so they are replaced only if the names
  // of the handles change.
  if (names !== parent.dataset["names"]) parent.replaceChildren(...shown.map(it => {
    const button = createButton("", "handle", () => {});
    button.dataset["handle"] = it.handle;
    button.dataset["object"] = String(it.object);
    button.append(create("span", "handle-label"));
    return button;
  }));
  parent.dataset["names"] = names;
  // The areas in which handles can be pressed do not overlap. They are larger for fingers, and on
  // the large page.
  const least = 1 + ((parent.firstElementChild as HTMLElement | null)?.offsetWidth ?? 0);
  const taken: Point[] = [];
  shown.forEach(({ at, label, owner }, i) => {
    const [x, y] = freePosition(where.toScreen(at as Point), taken, least, where.stage);
    taken.push([x, y]);
    const button = parent.children[i] as HTMLElement;
    button.setAttribute("aria-label", `${owner}: ${label}`);
    setText(button.firstElementChild as HTMLElement, label);
    button.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
  });
}

/** Returns a position near a handle's point that is at least `least` screen pixels away from the
 * positions in `taken`. If the point is inside of the `stage`, prefers positions inside. */
function freePosition([x, y]: Point, taken: readonly Point[], least: number,
  stage: HTMLElement): Point {
  const isFree = ([x, y]: Point) =>
    taken.every(it => Math.max(Math.abs(x - it[0]), Math.abs(y - it[1])) >= least);
  const [width, height] = [stage.clientWidth, stage.clientHeight];
  const isInside = ([x, y]: Point) => x >= 0 && y >= 0 && x <= width && y <= height;
  const free = OFFSETS.map(([dx, dy]): Point => [x + dx, y + dy]).filter(isFree);
  return (isInside([x, y]) ? free.find(isInside) : undefined) ?? free[0] ?? [x, y];
}

export const selection = new Selection();

for (const button of document.querySelectorAll<HTMLElement>("[data-kind]"))
  button.addEventListener("click", () => void add({ kind: button.dataset["kind"] }));
byId("duplicate").addEventListener("click", () => void add({ object: selection.index }));
byId("delete").addEventListener("click", remove);

/** Adds a block that the server writes: a new object, or a copy of the selected one. */
async function add(about: object): Promise<void> {
  const added = await editor.askCurrent<Added>("pinhole/add", about);
  if (added === null) return say("Nothing was added: the text has errors, or has changed.");
  // The cursor is put into the new block, so the object is selected as soon as it is listed.
  editor.view.dispatch({ changes: editor.changes(added.edits), scrollIntoView: true,
    selection: { anchor: added.cursor }, annotations: isolateHistory.of("full") });
  say(`${added.name ?? "A copy"} is added.`);
}

/** Deletes the block of the selected object. If nothing else is on the block's lines, deletes these
 * lines completely. */
function remove(): void {
  const { view, view: { state: { doc } } } = editor;
  const found = selection.selected;
  if (found === undefined) return;
  const [first, last] = [doc.lineAt(found.from), doc.lineAt(found.to)];
  const rest = doc.sliceString(first.from, found.from) + doc.sliceString(found.to, last.to);
  view.dispatch({ annotations: isolateHistory.of("full"), changes: rest.trim() === ""
    ? { from: first.from, to: Math.min(last.to + 1, doc.length) } : found });
}
