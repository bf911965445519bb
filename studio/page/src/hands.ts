// Hands: what is selected, and drags of it or of the camera, by mouse, touch and keyboard. One drag is one undo step.

import { byId, createButton, create, followPointer } from "./dom";
import type { SceneEditor } from "./editor";
import type { Frames } from "./frames";
import { Gesture } from "./gesture";
import type { OverlayLayer } from "./overlays";
import type { Picture } from "./picture";
import { isSuperseded, type Along, type Dragged, type DrawnObject, type Handle, type Pick, type Point, type Samples, type SceneObject } from "./protocol";
import type { Status } from "./status";

/** What a drag on the picture does, by the key that chooses it. All but the first move the camera. */
const TOOLS = { m: "move", o: "orbit", p: "pan", d: "dolly", r: "roll", v: "view_distance", l: "look" } as const;
type Tool = (typeof TOOLS)[keyof typeof TOOLS];

/** So many screen pixels a pointer may wander before it is a drag. */
const CLICK = 4;
/** How far an arrow key moves, in pixels of the picture; with the control key a tenth of it. */
const KEY_STEP = 10;

/** A pause after which the next arrow key begins another drag, in milliseconds. */
const KEY_PAUSE = 500;

const ARROWS: Record<string, Point> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** An object as it is called in sentences. */
export function nameOf(object: SceneObject): string {
  return object.name ?? object.kind;
}

/** A drag that goes on. It asks for one edit at a time, always about the newest place of the hand. */
class Drag {
  /** Where the hand is, what was asked for last, and up to where the text follows. */
  private target: Point;
  private asked: Point;
  private reached: Point;
  private busy = false;
  private ending = false;
  private readonly gesture: Gesture;

  constructor(private readonly hands: Hands, private readonly object: number | null, private readonly handle: string, start: Point) {
    this.target = this.asked = this.reached = start;
    this.gesture = new Gesture(hands.editor.view);
    hands.frames.dragging = this;
  }

  /** Moves the handle to a point of the picture, or the pointer for the camera. */
  to(target: Point): void {
    this.target = target;
    void this.run();
  }

  by([dx, dy]: Point): void {
    this.to([this.target[0] + dx, this.target[1] + dy]);
  }

  /** Ends when the last place of the hand has been reached. */
  end(): void {
    this.ending = true;
    if (!this.busy) this.finish();
  }

  cancel(): void {
    this.target = this.asked;
    this.release();
    this.gesture.cancel();
  }

  private async run(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    while (this.target !== this.asked) await this.step(this.target);
    this.busy = false;
    if (this.ending) this.finish();
  }

  private async step(to: Point): Promise<void> {
    const { editor, frames, status, along } = this.hands;
    const { doc } = editor.view.state;
    this.asked = to;
    try {
      const about = { object: this.object, handle: this.handle, from: this.reached, to, along };
      const answer = await editor.request<Dragged | null>("pinhole/drag", about);
      if (answer === null) return status.say("The text has errors. Mend them, then the picture can be changed by hand.", "warning");
      // An answer about another text does not count. A way too short for another digit counts on with the next one.
      if (editor.view.state.doc !== doc || answer.edits.length === 0) return;
      this.reached = to;
      this.gesture.apply(editor.changes(answer.edits));
      status.say(answer.values.join(", "));
      await frames.coarse;
    } catch (error) {
      if (!isSuperseded(error)) status.say((error as Error).message, "warning");
    }
  }

  private finish(): void {
    this.release();
    this.gesture.end();
  }

  /** Another drag may have begun before this one has come to its end. */
  private release(): void {
    if (this.hands.frames.dragging === this) this.hands.frames.dragging = null;
  }
}

export class Hands {
  private tool: Tool = "move";
  private selected: number | null = null;
  /** Whether the object at the cursor is not to be selected, until the cursor moves. */
  private deselected = false;
  /** An object that was selected although the overlays have no outline of it: they have those of the first objects alone, unless one is asked for. */
  beyond: number | null = null;
  /** Called when there is such an object. */
  onBeyond: () => void = () => {};
  private drag: Drag | null = null;
  private readonly pointers = new Map<number, Point>();
  private readonly handles = byId("handles");
  private readonly objects = byId<HTMLSelectElement>("objects");
  private readonly alongMenu = byId<HTMLSelectElement>("along");
  private shift = false;
  private space = false;
  private pause = 0;
  private hovering = false;
  private hoverNext: Point | null = null;

  constructor(
    readonly editor: SceneEditor,
    readonly frames: Frames,
    readonly picture: Picture,
    readonly overlays: OverlayLayer,
    readonly status: Status,
  ) {
    for (const input of document.querySelectorAll<HTMLInputElement>("input[name=tool]")) {
      input.addEventListener("change", () => this.choose(input.value as Tool));
    }
    this.objects.addEventListener("change", () => this.select(this.overlays.data?.objects.find(it => String(it.index) === this.objects.value) ?? null));
    const { stage } = picture;
    stage.addEventListener("pointerdown", event => this.press(event));
    stage.addEventListener("pointermove", event => this.moved(event));
    for (const end of ["pointerup", "pointercancel"] as const) stage.addEventListener(end, event => this.pointers.delete(event.pointerId));
    stage.addEventListener("pointerleave", () => this.leave());
    stage.addEventListener("keydown", event => this.key(event));
    stage.addEventListener("keyup", event => this.keyUp(event));
    stage.addEventListener("focusout", () => {
      this.endDrag();
      this.freeSpace();
    });
    stage.addEventListener("contextmenu", event => event.preventDefault());
  }

  /** What drags of objects are held to. */
  get along(): Along | undefined {
    if (this.shift) return "floor";
    return (this.alongMenu.value || undefined) as Along | undefined;
  }

  /** New overlays have come: handles move, and the list of objects may be another. */
  refresh(): void {
    const objects = this.overlays.data?.objects ?? [];
    const names = objects.map(it => (it.name === null ? `${it.kind} (${it.range.start.line + 1})` : `${it.name} (${it.kind})`));
    if ([...this.objects.options].slice(1).map(it => it.text).join("\n") !== names.join("\n")) {
      const options = objects.map((object, i) => new Option(names[i], String(object.index)));
      this.objects.replaceChildren(new Option("Nothing selected", ""), ...options);
    }
    this.follow();
  }

  /** Selects the object that the cursor has been moved into. */
  cursorMoved(): void {
    this.deselected = false;
    this.follow();
  }

  private follow(): void {
    const { head } = this.editor.view.state.selection.main;
    const found = this.deselected ? undefined : this.editor.objectAt(this.overlays.data?.objects ?? [], head);
    this.selected = found?.index ?? null;
    this.objects.value = found === undefined ? "" : String(found.index);
    this.overlays.select(found ?? null);
    this.place();
  }

  /** Puts the handles of the selected object where they are seen. */
  place(): void {
    const object = this.selectedObject();
    const shown = (object?.handles ?? []).filter(it => it.at !== null);
    const old = [...this.handles.children] as HTMLButtonElement[];
    const same = old.length === shown.length && old.every((button, i) => button.dataset["handle"] === shown[i]?.handle && button.dataset["object"] === String(object?.index));
    const buttons = same ? old : shown.map(handle => this.createHandle(object as DrawnObject, handle));
    if (!same) this.handles.replaceChildren(...buttons);
    shown.forEach(({ at }, i) => {
      const [x, y] = this.picture.toScreen(at as Point);
      const button = buttons[i] as HTMLButtonElement;
      button.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
      // The centre lies above the others, where they meet.
      button.style.zIndex = i === 0 ? "1" : "";
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

  private selectedObject(): DrawnObject | undefined {
    return this.overlays.data?.objects.find(it => it.index === this.selected);
  }

  private choose(tool: Tool): void {
    this.tool = tool;
    this.picture.stage.dataset["tool"] = tool;
    for (const input of document.querySelectorAll<HTMLInputElement>("input[name=tool]")) input.checked = input.value === tool;
  }

  /** Selects an object and shows its line; nothing for null. */
  private select(object: SceneObject | null): void {
    if (object !== null) {
      if (!this.overlays.data?.objects.some(it => it.index === object.index)) {
        this.beyond = object.index;
        this.onBeyond();
      }
      this.editor.jump(object.selection.start);
      return;
    }
    this.deselected = true;
    this.follow();
  }

  private press(event: PointerEvent): void {
    const { stage } = this.picture;
    const at = this.picture.local(event);
    this.pointers.set(event.pointerId, at);
    stage.setPointerCapture(event.pointerId);
    const button = (event.target as Element).closest<HTMLButtonElement>(".handle");
    this.shift = event.shiftKey;
    if (this.pointers.size > 1) {
      // A second finger zooms: what the first one has begun does not count.
      this.drag?.cancel();
      this.drag = null;
      return;
    }
    if (event.button !== 0 || this.space) return;
    const start = this.picture.toPicture(at);
    const object = this.selectedObject();
    const handle = object?.handles.find(it => it.handle === button?.dataset["handle"]);
    if (object !== undefined && handle !== undefined) this.dragHandle(event, object, handle);
    else if (this.tool === "move") void this.grab(event, start);
    else this.dragAfter(event, new Drag(this, null, this.tool, start), start);
  }

  /** Has a handle go where the pointer goes, at the distance from it that it has now. */
  private dragHandle(event: PointerEvent, object: DrawnObject, { handle, at }: Handle, begin: Point = this.picture.toPicture(this.picture.local(event))): void {
    if (at !== null) this.dragAfter(event, new Drag(this, object.index, handle, at), begin, at);
  }

  private dragAfter(event: PointerEvent, drag: Drag, begin: Point, at: Point = begin): void {
    this.drag = drag;
    let moved = false;
    const move = (next: PointerEvent) => {
      if (this.drag !== drag) return;
      this.shift = next.shiftKey;
      const [x, y] = this.picture.toPicture(this.picture.local(next));
      moved ||= Math.hypot(x - begin[0], y - begin[1]) * this.picture.zoom > CLICK;
      if (moved) drag.to([at[0] + x - begin[0], at[1] + y - begin[1]]);
    };
    followPointer(event, move, () => {
      if (this.drag === drag) this.endDrag();
    });
  }

  /** Selects what is under the pointer, and drags it by its centre if the pointer moves on. */
  private async grab(event: PointerEvent, start: Point): Promise<void> {
    const pick = await this.editor.ask<Pick>("pinhole/pick", { point: start });
    this.select(pick?.object ?? null);
    const object = this.selectedObject();
    const middle = object?.handles.find(({ handle }) => handle === "center" || handle === "centroid");
    // The button may be up by now, or a second finger down.
    const isHeld = this.pointers.size === 1 && this.pointers.has(event.pointerId);
    if (isHeld && object !== undefined && middle !== undefined && this.drag === null) this.dragHandle(event, object, middle, start);
  }

  private moved(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    const at = this.picture.local(event);
    if (before !== undefined) {
      const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
      const other = others[0]?.[1];
      if (other !== undefined) {
        const distance = (one: Point) => Math.max(1, Math.hypot(one[0] - other[0], one[1] - other[1]));
        this.picture.zoomBy(distance(at) / distance(before), other);
        this.picture.panBy((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
      } else if (event.buttons === 4 || (this.space && event.buttons === 1)) {
        this.picture.panBy(at[0] - before[0], at[1] - before[1]);
      }
      this.pointers.set(event.pointerId, at);
    }
    if (event.buttons === 0 && event.pointerType !== "touch") void this.hover(this.picture.toPicture(at));
  }

  private leave(): void {
    this.hoverNext = null;
    this.overlays.hover(null);
    this.overlays.showSamples([0, 0], null);
    this.status.point("");
  }

  /** Names what is under the pointer. While one answer is awaited, only the newest place is remembered. */
  private async hover(point: Point): Promise<void> {
    this.hoverNext = point;
    if (this.hovering) return;
    this.hovering = true;
    while (this.hoverNext !== null) {
      const next: Point = this.hoverNext;
      this.hoverNext = null;
      const pick = this.picture.isInside(next) ? await this.editor.ask<Pick>("pinhole/pick", { point: next }) : null;
      this.status.point(pick === null ? "" : described(pick, next));
      this.overlays.hover(pick?.object?.index ?? null);
      if (pick === null || !this.overlays.isOn("samples")) continue;
      const pixel: Point = [Math.floor(next[0]), Math.floor(next[1])];
      this.overlays.showSamples(pixel, await this.editor.ask<Samples>("pinhole/samples", { pixel }));
    }
    this.hovering = false;
  }

  private key(event: KeyboardEvent): void {
    const arrow = ARROWS[event.key];
    this.shift = event.shiftKey;
    clearTimeout(this.pause);
    if (arrow === undefined && event.key !== "Escape" && event.key !== "Shift") this.endDrag();
    if (event.altKey || event.metaKey || (event.ctrlKey && arrow === undefined)) return;
    if (arrow !== undefined) {
      const step = event.ctrlKey ? KEY_STEP / 10 : KEY_STEP;
      this.drag ??= this.keyDrag(event.target as Element);
      this.drag?.by([arrow[0] * step, arrow[1] * step]);
    } else if (event.key === "Escape") {
      if (this.drag === null) this.select(null);
      this.drag?.cancel();
      this.drag = null;
    } else if (event.key === " ") {
      this.space = true;
      this.picture.stage.dataset["space"] = "";
    } else if (event.key in TOOLS) this.choose(TOOLS[event.key as keyof typeof TOOLS]);
    else if ("xyz".includes(event.key)) this.hold(event.key);
    else if (event.key === "f") this.hold("floor");
    else if (event.key === "+" || event.key === "=") this.picture.zoomBy(2);
    else if (event.key === "-") this.picture.zoomBy(0.5);
    else if (event.key === "0") this.picture.fit();
    else if (event.key === "1") this.picture.actualSize();
    else return;
    event.preventDefault();
  }

  private keyUp(event: KeyboardEvent): void {
    this.shift = event.shiftKey;
    if (event.key === " ") this.freeSpace();
    // Taps that follow each other are one drag.
    if (event.key in ARROWS) this.pause = setTimeout(() => this.endDrag(), KEY_PAUSE);
  }

  private freeSpace(): void {
    this.space = false;
    delete this.picture.stage.dataset["space"];
  }

  /** Holds drags to an axis, or frees them of it. */
  private hold(along: string): void {
    this.alongMenu.value = this.alongMenu.value === along ? "" : along;
    this.status.say(`Drags of objects: ${this.alongMenu.selectedOptions[0]?.text.toLowerCase() ?? ""}.`);
  }

  /** The drag that an arrow key begins: of the focused handle, else of the selected object or the camera. */
  private keyDrag(focused: Element): Drag | null {
    const object = this.selectedObject();
    const name = focused.closest<HTMLElement>(".handle")?.dataset["handle"];
    const handle = name === undefined ? object?.handles[0] : object?.handles.find(it => it.handle === name);
    if (name === undefined && this.tool !== "move") {
      const [width, height] = this.picture.size;
      // Roll turns about the middle: one has to take hold beside of it.
      return new Drag(this, null, this.tool, [this.tool === "roll" ? 0.75 * width : width / 2, height / 2]);
    }
    if (object !== undefined && handle?.at) return new Drag(this, object.index, handle.handle, handle.at);
    this.status.say("Select an object, or choose what the camera does.", "warning");
    return null;
  }

  private endDrag(): void {
    clearTimeout(this.pause);
    this.drag?.end();
    this.drag = null;
  }
}

/** A sentence on what is seen at a point. */
function described({ object, point, distance, color }: Pick, at: Point): string {
  const pixel = `pixel ${Math.floor(at[0])}, ${Math.floor(at[1])}`;
  if (object === null || point === null || distance === null) return `background ${color} · ${pixel}`;
  return `${nameOf(object)} at (${point.map(short).join(", ")}) · ${short(distance)} away · ${color} · ${pixel}`;
}

function short(value: number): string {
  return String(Number(value.toPrecision(4)));
}
