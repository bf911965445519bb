// The view from outside: the same scene by a second camera, with the scene's own camera drawn in
// it. A drag there turns the view, or moves an object or a handle of the scene's camera.

import { inAddress } from "./address";
import { connection } from "./connection";
import { byId, createSvg, followPointer, newestOf, remember, remembered } from "./dom";
import { Drag, dragWith, type Held } from "./drag";
import { editor } from "./editor";
import { files } from "./files";
import { Frames, frames } from "./frames";
import { ARROWS, dragByKey, endKeys } from "./keys";
import { drawLines, overlays } from "./overlays";
import { Picture, picture as main } from "./picture";
import { grab } from "./pointers";
import type { CameraLine, Overlays, Point, Vector, View } from "./protocol";
import { handlesOf, placeHandles, selection, type OwnedHandle } from "./selection";
import { tools } from "./tools";
import { setText } from "./visible";

/** Samples of a pixel when nothing moves; enough for smooth edges, and soon rendered. */
const SAMPLES = 16;
/** Maximum number of device pixels for a pixel of the page. More would not be seen. */
const SHARPEST = 2;
/** Greatest angle between the level and the direction of the view, in radians: a little less than a
 * right angle, at which the picture's top would not be defined. */
const STEEPEST = Math.PI / 2 - 1e-3;
/** Time, in ms, after which a coarse picture is late. During a drag, no further one is requested
 * then until the drag ends, because the main picture would have to wait for it. */
const LATE = 40;
/** Angle by which an arrow key turns the view, in heights of the picture. */
const KEY_TURN = 1 / 24;

const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** Returns `a + b · by`. */
const plus = (a: Vector, b: Vector, by = 1): Vector =>
  [a[0] + b[0] * by, a[1] + b[1] * by, a[2] + b[2] * by];

/** Order in which the lines of the camera are drawn; the last one is on top. */
const LINES: CameraLine[] = ["frustum", "far", "near", "axis", "rays", "window", "up", "ray"];
/** Handles whose names are always shown, on the given side. */
const NAMED: Record<string, "above" | "below"> = { eye: "above", lookat: "below",
  direction: "below", d: "below", view_height: "above", fov: "above", hfov: "above" };

class Outside {
  readonly picture = new Picture(byId("outside"), byId<HTMLCanvasElement>("outside-canvas"), 0);
  /** The camera of the view; null until the server has chosen it. */
  view: View | null = null;
  /** Direction from which the server chooses the view; undefined for the usual one. */
  private from: Vector | undefined;
  /** Whether the user has chosen the view, so that a link contains it. */
  private isChosen = false;
  private data: Overlays | null = null;
  private isTrue = false;
  private pointed: Point | null = null;
  /** Whether a new picture is needed, and not only new lines. */
  private needsFrame = false;
  /** Scene of the view. The view of another one is chosen anew. */
  private scene = files.at;
  private begin = 0;
  private took = 0;
  private readonly svg = document.querySelector("#outside-lines") as SVGElement;
  private readonly handles = byId("outside-handles");
  private readonly frames = new Frames(() => ({ view: this.view, samples: SAMPLES }));
  private readonly box = byId<HTMLInputElement>("outside-shown");

  constructor() {
    const { box, picture, picture: { stage } } = this;
    box.checked = remembered("outside") !== "hidden";
    box.addEventListener("change", () => this.show(box.checked));
    byId("outside-hide").addEventListener("click", () => this.show(false));
    byId("dock").hidden = !box.checked;
    this.open();
    addEventListener("hashchange", () => this.open());
    picture.onView = () => {
      this.draw();
      if (this.view === null || String(this.size) !== String(this.view.size)) this.changed();
    };
    picture.onWheel = turned => this.zoom(2 ** turned);
    this.frames.onShow = shown => {
      if (shown.fineness === "coarse") this.took = performance.now() - this.begin;
      picture.show(shown);
    };
    for (const button of document.querySelectorAll<HTMLElement>("[data-from]"))
      button.addEventListener("click", () => {
        const from = button.dataset["from"];
        this.look(from ? from.split(" ").map(Number) as unknown as Vector : undefined);
      });
    stage.addEventListener("pointerdown", event => this.press(event));
    stage.addEventListener("keydown", event => this.key(event));
    stage.addEventListener("focusout", () => endKeys());
    stage.addEventListener("contextmenu", event => event.preventDefault());
  }

  /** Takes the view from the page's address, if it has one. */
  private open(): void {
    const numbers = inAddress("view")?.split(",").map(Number) ?? [];
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return;
    const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0] = numbers;
    this.view = { eye: [a, b, c], lookat: [d, e, f], up: [0, 1, 0], fov: 30, size: this.size };
    this.isChosen = true;
    this.changed();
  }

  /** The view, as a part of the page's address; empty if the user has not chosen it. */
  get inLink(): string {
    if (this.view === null || !this.isChosen || !this.isShown) return "";
    const numbers = [...this.view.eye, ...this.view.lookat];
    return `&view=${numbers.map(it => Number(it.toPrecision(6))).join(",")}`;
  }

  private show(isShown: boolean): void {
    this.box.checked = isShown;
    byId("dock").hidden = !isShown;
    remember("outside", isShown ? "shown" : "hidden");
    if (!isShown && document.activeElement === document.body) main.stage.focus();
    this.changed();
  }

  private get isShown(): boolean { return this.picture.stage.clientWidth > 0; }

  private get size(): Point {
    const { clientWidth, clientHeight } = this.picture.stage;
    const sharp = Math.min(SHARPEST, devicePixelRatio);
    return [Math.max(1, Math.round(clientWidth * sharp)),
      Math.max(1, Math.round(clientHeight * sharp))];
  }

  /** Requests the view anew, because the text, the view or its size has changed. */
  changed(): void {
    this.needsFrame = true;
    void this.refresh();
  }

  /** Draws the ray through a point of the main picture; if `at` is null, none. */
  point(at: Point | null): void {
    if (String(at) === String(this.pointed)) return;
    this.pointed = at;
    void this.refresh();
  }

  /** Lets the server choose the view, from the direction `from` or from the usual one. */
  private look(from: Vector | undefined): void {
    this.view = null;
    this.from = from;
    this.isChosen = from !== undefined;
    this.changed();
  }

  /** Requests the lines after the main picture has arrived, and then the picture. */
  readonly refresh = newestOf<void>(async () => {
    for (let its; its !== frames.coarse; await its) its = frames.coarse;
    if (connection.state !== "open" || !this.isShown || editor.uri === "") return;
    if (files.at !== this.scene && files.at.of !== this.scene) {
      this.view = null;
      this.from = undefined;
      this.isChosen = false;
    }
    this.scene = files.at;
    const { doc } = editor.view.state;
    const asked = this.view && (this.view = { ...this.view, size: this.size });
    const answer = await editor.ask<Overlays>("pinhole/overlays", { only: this.objects,
      point: this.pointed, view: asked ?? { from: this.from, size: this.size } });
    this.isTrue = answer !== null;
    if (answer !== null && editor.view.state.doc === doc) {
      this.data = answer;
      if (this.view === asked) this.view = answer.view ?? null;
    }
    setText(byId("outside-note"), this.isTrue ? "" : "The text has errors.");
    this.draw();
    const isLate = frames.dragging !== null && this.took > LATE;
    if (!this.needsFrame || this.view === null || isLate) return;
    this.needsFrame = false;
    this.begin = performance.now();
    this.frames.changed();
  });

  /** Objects whose outlines are drawn. */
  private get objects(): number[] {
    return [selection.index, overlays.hovered].filter(it => it !== null);
  }

  draw(): void {
    const { data, picture, svg } = this;
    svg.replaceChildren();
    const camera = data?.camera;
    const handles = this.owned;
    placeHandles(this.handles, picture, handles);
    if (!data || !camera) return;
    const group = createSvg("g", { transform: picture.matrix });
    svg.append(group);
    // What is dragged is highlighted, in whichever picture it is dragged.
    const { dragging } = frames;
    const held = dragging instanceof Drag ? dragging.held : null;
    svg.toggleAttribute("data-camera-held", held !== null && held.object === null);
    for (const { index, outline } of this.isTrue ? data.objects : []) {
      const isHeld = held?.object === index ? " held" : "";
      drawLines(group, `outline ${index === selection.index ? "selected" : "hovered"}${isHeld}`,
        outline);
    }
    for (const name of LINES) drawLines(group, `camera ${name}`, camera.lines[name] ?? []);
    for (const [x, y] of camera.met.map(it => picture.toScreen(it)))
      svg.append(createSvg("circle", { cx: x, cy: y, r: 3.5, class: "met" }));
    for (const { at, label, object, handle } of handles) {
      const side = object === null ? NAMED[handle] : undefined;
      if (at === null || side === undefined) continue;
      const [x, y] = picture.toScreen(at);
      const text = createSvg("text", { x, y: y + (side === "above" ? -13 : 23), class: "mark",
        "text-anchor": "middle" });
      setText(text, label);
      svg.append(text);
    }
  }

  /** Handles of the scene's camera, and the first one of the selected object. */
  private get owned(): OwnedHandle[] {
    const { data } = this;
    if (!data?.camera || !this.isTrue) return [];
    const of = data.objects.filter(it => it.index === selection.index);
    return [...data.camera.handles.map(it => ({ ...it, object: null, owner: "Outside, camera" })),
      ...of.flatMap(it => handlesOf(it).slice(0, 1))
        .map(it => ({ ...it, owner: `Outside, ${it.owner}` }))];
  }

  /** Returns the handle that `element` shows, or null if it shows none. */
  private held(element: Element): Held | null {
    const { handle, object } = element.closest<HTMLElement>(".handle")?.dataset ?? {};
    const found = this.owned.find(it => it.handle === handle && String(it.object) === object);
    return found?.at ? { object: found.object, handle: found.handle, at: found.at } : null;
  }

  private press(event: PointerEvent): void {
    const { picture, picture: { stage } } = this;
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true });
    endKeys();
    tools.held = event;
    const at = picture.toPicture(picture.local(event));
    const held = this.held(event.target as Element);
    if (held !== null && event.button === 0) return void dragWith(event, at, () => held, this);
    // The left button drags an object if the pointer is over one, and turns the view otherwise.
    let isObject = event.button === 0 ? null : false;
    const hold = async () => {
      const found = await grab(at, this.view, it => it !== null && it.kind !== "checkerboard");
      isObject = found !== null;
      return found;
    };
    const cancel = isObject === null ? dragWith(event, at, hold, this) : () => {};
    const before = this.view;
    let last: Point = [event.clientX, event.clientY];
    const move = ({ clientX, clientY, shiftKey }: PointerEvent) => {
      if (isObject !== false) return;
      const by: Point = [clientX - last[0], clientY - last[1]];
      last = [clientX, clientY];
      if (event.button === 1 || shiftKey) this.pan(by);
      else this.turn([by[0] / stage.clientHeight, by[1] / stage.clientHeight]);
    };
    followPointer(event, move, () => {}, () => {
      cancel();
      this.view = before;
      this.changed();
    });
  }

  private key(event: KeyboardEvent): void {
    const arrow = ARROWS[event.key];
    const held = this.held(event.target as Element);
    tools.held = event;
    if (event.altKey || event.metaKey) return;
    if (arrow !== undefined && held !== null) {
      dragByKey(event, arrow, () => new Drag(held.at, () => held, this));
    } else if (arrow !== undefined) this.turn([arrow[0] * KEY_TURN, arrow[1] * KEY_TURN]);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.25);
    else if (event.key === "-") this.zoom(1.25);
    else if (event.key === "0") this.look(undefined);
    else return;
    event.preventDefault();
  }

  /** Sets the view as the user has moved it. */
  private move(eye: Vector, lookat: Vector): void {
    if (this.view === null || ![...eye, ...lookat].every(Number.isFinite)) return;
    this.view = { ...this.view, eye, lookat };
    this.isChosen = true;
    this.changed();
  }

  /** Turns the view about its middle. A movement by the picture's height is half a turn. */
  private turn([dx, dy]: Point): void {
    if (this.view === null) return;
    const { eye, lookat } = this.view;
    const [x, y, z] = minus(eye, lookat);
    const distance = Math.hypot(x, y, z);
    const around = Math.atan2(x, z) - dx * Math.PI;
    const up = Math.asin(y / distance) + dy * Math.PI;
    const steep = Math.max(-STEEPEST, Math.min(STEEPEST, up));
    const level = Math.cos(steep);
    const side: Vector = [level * Math.sin(around), Math.sin(steep), level * Math.cos(around)];
    this.move(plus(lookat, side, distance), lookat);
  }

  private zoom(factor: number): void {
    if (this.view === null) return;
    const { eye, lookat } = this.view;
    this.move(plus(lookat, minus(eye, lookat), factor), lookat);
  }

  /** Shifts the view by screen pixels, so that its middle follows the pointer. */
  private pan([dx, dy]: Point): void {
    if (this.view === null) return;
    const { eye, lookat, fov } = this.view;
    const [x, y, z] = minus(eye, lookat);
    const [distance, level] = [Math.hypot(x, y, z), Math.hypot(x, z)];
    const pixel = 2 * distance * Math.tan(fov * Math.PI / 360) / this.picture.stage.clientHeight;
    const right: Vector = level === 0 ? [1, 0, 0] : [z / level, 0, -x / level];
    const top: Vector = [-x * y / level / distance, level / distance, -z * y / level / distance];
    const by = plus(plus([0, 0, 0], right, -dx * pixel), top, dy * pixel);
    this.move(plus(eye, by), plus(lookat, by));
  }
}

export const outside = new Outside();
