// The view from outside: a picture of the scene by a second camera, in which the scene's own camera
// is drawn. A drag in it turns the view, or moves an object or a handle of the scene's camera.

import { inAddress } from "./address";
import { connection } from "./connection";
import { showPart } from "./dock";
import { byId, createSvg, followPointer, newestOf, remember, remembered } from "./dom";
import { Drag, dragWith, type Held } from "./drag";
import { editor } from "./editor";
import { files } from "./files";
import { Fingers } from "./fingers";
import { Frames, frames, LARGEST } from "./frames";
import { ARROWS, dragByKey, endKeys } from "./keys";
import { drawLines, overlays } from "./overlays";
import { Picture, picture as main } from "./picture";
import { grab } from "./pointers";
import type { CameraLine, Frame, Overlays, Point, Polyline, Vector, View }
  from "./protocol";
import { handlesOf, placeHandles, selection, type OwnedHandle } from "./selection";
import { tools } from "./tools";
import { setText } from "./visible";

/** Samples per pixel of this view when nothing moves. With fewer samples, edges would be jagged;
 * more samples would take longer. */
const SAMPLES = 16;
/** Maximum resolution of the view's picture, in device pixels per CSS pixel. A higher resolution
 * would hardly be visible. */
const SHARPEST = 2;
/** Maximum angle between the direction of the view and the horizontal, in radians. It is a little
 * less than a right angle, at which the picture's up direction would be undefined. */
const STEEPEST = Math.PI / 2 - 1e-3;
/** Maximum time, in ms, that a coarse picture of this view may take during a drag. After a slower
 * picture, the view gets no new one until the drag ends, so that the main picture need not wait. */
const LATE = 40;
/** Angle by which an arrow key turns the view. It is given as a movement of the pointer, in heights
 * of the picture; a whole height turns the view by 180°. */
const KEY_TURN = 1 / 24;

const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** Returns `a + b · by`. */
const plus = (a: Vector, b: Vector, by = 1): Vector =>
  [a[0] + b[0] * by, a[1] + b[1] * by, a[2] + b[2] * by];

/** Order in which the lines of the camera are drawn; the last one is on top. */
const LINES: CameraLine[] = ["frustum", "far", "near", "axis", "rays", "window", "up", "ray"];
/** CSS class of the view while it is drawn for an SVG. It gives the SVG the style of paper. */
const INK = "ink";
/** Properties of lines and labels that an SVG of the view keeps. */
const STYLE = ["display", "fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin",
  "paint-order", "font-family", "font-size"];
/** Handles of the camera whose names are drawn, and the side on which each name stands. The last
 * three names are visible only on paper and in an SVG. */
const NAMED: Record<string, "above" | "below"> = { eye: "above", lookat: "below",
  direction: "below", d: "below", view_height: "above", fov: "above", hfov: "above",
  up: "above", near: "below", far: "below" };

/** Distances of labels from their handles: above and below. */
const SIDES = ["-1.1em", "1.9em"];
/** Width of an SVG of the view, in units of the SVG. It equals the width of a printed page, 180 mm,
 * in CSS pixels, so that labels are as large as on paper. */
const SVG_WIDTH = 680;

/** Returns the handles of the scene's camera. */
const ofCamera = ({ camera }: Overlays): OwnedHandle[] =>
  camera?.handles.map(it => ({ ...it, object: null, owner: "Outside, camera" })) ?? [];

class Outside {
  readonly picture = new Picture(byId("outside"), byId<HTMLCanvasElement>("outside-canvas"), 0);
  /** The camera of the view; null until the server has chosen it. */
  view: View | null = null;
  /** Direction from which the server chooses the view; undefined if the server also chooses the
   * direction. */
  private from: Vector | undefined;
  /** Whether the user has chosen the view, so that a link contains it. */
  private isChosen = false;
  private data: Overlays | null = null;
  private isTrue = false;
  /** Whether the eye and the window have been in the picture since the user last moved the view. */
  private sawCamera = false;
  private rayPoint: Point | null = null;
  /** Whether a new picture is needed, and not only new lines. */
  private needsFrame = false;
  /** Scene that the view shows. If the page shows another scene, the server chooses a new view. */
  private scene = files.current;
  private begin = 0;
  private took = 0;
  private readonly svg = document.querySelector("#outside-lines") as SVGElement;
  private readonly handles = byId("outside-handles");
  /** The view whose picture was requested last. Unlike `view`, it is not null while the server
   * chooses another view: a request without a view would be about the main picture. */
  private requestedView: View | null = null;
  private readonly frames = new Frames(() => ({ view: this.requestedView, samples: SAMPLES }));
  private readonly box = byId<HTMLInputElement>("outside-shown");
  private readonly fingers = new Fingers(this.picture, factor => this.zoom(1 / factor),
    by => this.pan(by));

  constructor() {
    const { box, picture, picture: { stage } } = this;
    box.checked = remembered("outside") !== "hidden";
    box.addEventListener("change", () => this.show(box.checked));
    byId("outside-hide").addEventListener("click", () => this.show(false));
    showPart(byId("outside-part"), box.checked);
    this.openAddressed();
    addEventListener("hashchange", () => this.openAddressed());
    picture.onView = () => {
      this.draw();
      if (this.view !== null && String(this.size) === String(this.view.size)) return;
      // If the user has not chosen the view, the server chooses it again, for the new size.
      if (!this.isChosen) this.view = null;
      this.changed();
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
  }

  /** Shows the view that the page's address contains, if it contains one. */
  private openAddressed(): void {
    const numbers = inAddress("view")?.split(",").map(Number) ?? [];
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return;
    const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0] = numbers;
    this.view = { eye: [a, b, c], lookat: [d, e, f], up: [0, 1, 0], fov: 30, size: this.size };
    this.isChosen = true;
    this.changed();
  }

  /** The view, as a part of the page's address; empty if the user has not chosen it. */
  get linkFragment(): string {
    if (this.view === null || !this.isChosen || !this.isShown) return "";
    const numbers = [...this.view.eye, ...this.view.lookat];
    return `&view=${numbers.map(it => Number(it.toPrecision(6))).join(",")}`;
  }

  private show(isShown: boolean): void {
    this.box.checked = isShown;
    showPart(byId("outside-part"), isShown);
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

  /** Draws the ray through the point `at` of the main picture. If `at` is null, draws no ray. */
  point(at: Point | null): void {
    if (String(at) === String(this.rayPoint)) return;
    this.rayPoint = at;
    void this.refresh();
  }

  /** Lets the server choose the view from the direction `from`. If `from` is undefined, the server
   * also chooses the direction. */
  private look(from: Vector | undefined): void {
    this.view = null;
    this.from = from;
    this.isChosen = from !== undefined;
    this.changed();
  }

  /** Waits for the main picture, and then requests the lines of this view. Requests the picture of
   * this view last. */
  readonly refresh = newestOf<void>(async () => {
    for (let its; its !== frames.coarse; await its) its = frames.coarse;
    if (connection.state !== "open" || !this.isShown || editor.uri === "") return;
    if (files.current !== this.scene && files.current.of !== this.scene) {
      this.view = null;
      this.from = undefined;
      this.isChosen = false;
      if (files.current.from === "link") this.openAddressed();
    }
    this.scene = files.current;
    const { doc } = editor.view.state;
    const { size } = this;
    const asked = this.view && (this.view = { ...this.view, size });
    const only = [selection.index, overlays.hovered].filter(it => it !== null);
    const answer = await editor.ask<Overlays>("pinhole/overlays", { only,
      point: this.rayPoint, view: asked ?? { from: this.from, size } });
    this.isTrue = answer !== null;
    if (answer !== null && editor.view.state.doc === doc) {
      this.data = answer;
      // A view that was chosen for another size is not used; another request follows.
      const fits = asked !== null || String(size) === String(this.size);
      if (this.view === asked && fits) this.view = answer.view ?? null;
      // If a change of the text has moved the scene's camera out of the picture, the server chooses
      // the view again, but not during a drag, which a new view would disturb. If the user has
      // chosen the view, its direction is kept.
      if (this.seesCamera) this.sawCamera = true;
      else if (this.sawCamera && this.view !== null && frames.dragging === null) {
        this.sawCamera = false;
        if (this.isChosen) this.from = minus(this.view.eye, this.view.lookat);
        this.view = null;
        return this.changed();
      }
    }
    const isBroken = !this.isTrue && connection.state === "open";
    setText(byId("outside-note"), isBroken ? "The text has errors." : "");
    this.draw();
    const isLate = frames.dragging !== null && this.took > LATE;
    if (!this.needsFrame || this.view === null || isLate) return;
    this.needsFrame = false;
    this.requestedView = this.view;
    this.begin = performance.now();
    this.frames.changed();
  });

  /** Whether the handles of the eye and of the window are in the picture. */
  private get seesCamera(): boolean {
    const of = this.data?.camera?.handles.filter(({ handle }) => /^(eye|d)$/.test(handle)) ?? [];
    const isInside = (at: Point) => at.every((it, axis) => it >= 0 && it <= (this.size[axis] ?? 0));
    return of.length > 0 && of.every(({ at }) => at !== null && isInside(at));
  }

  draw(): void {
    const { data, picture, owned, svg } = this;
    placeHandles(this.handles, picture, owned);
    svg.replaceChildren();
    if (data !== null) this.drawData(svg, data, owned, it => picture.toScreen(it));
  }

  /** Draws `data` into `svg`. `place` converts its points to those of `svg`. */
  private drawData(svg: SVGElement, { camera, objects }: Overlays,
    handles: readonly OwnedHandle[], place: (point: Point) => Point): void {
    if (camera === undefined) return;
    const draw = (name: string, lines: readonly Polyline[]) =>
      drawLines(svg, name, lines.map(line => line.map(place)));
    // A dragged object or camera is highlighted here even if it is dragged in the main picture.
    const { dragging } = frames;
    const held = dragging instanceof Drag ? dragging.held : null;
    svg.toggleAttribute("data-camera-held", held !== null && held.object === null);
    for (const { index, kind, outline } of this.isTrue ? objects : []) {
      const isHeld = held?.object === index ? " held" : "";
      const state = index === selection.index ? "selected" : "hovered";
      draw(`outline ${kind} ${state}${isHeld}`, outline);
    }
    for (const name of LINES) draw(`camera ${name}`, camera.lines[name] ?? []);
    for (const [x, y] of camera.met.map(place))
      svg.append(createSvg("circle", { cx: x, cy: y, r: 3.5, class: "met" }));
    const taken: DOMRect[] = [];
    for (const { at, label, object, handle } of handles) {
      const side = object === null ? NAMED[handle] : undefined;
      if (at === null || side === undefined) continue;
      const [x, y] = place(at);
      const text = createSvg("text", { x, y, class: `mark ${handle}`, "text-anchor": "middle" });
      setText(text, label);
      svg.append(createSvg("circle", { cx: x, cy: y, r: 3.5, class: "dot" }), text);
      // A label that would overlap an earlier one moves to the other side of its handle. If it
      // would overlap there, too, it is left out.
      const isFree = (dy: string) => {
        text.setAttribute("dy", dy);
        const box = DOMRect.fromRect(text.getBBox());
        return taken.every(it => box.left >= it.right || box.right <= it.left
          || box.top >= it.bottom || box.bottom <= it.top) && taken.push(box) > 0;
      };
      if (!(side === "above" ? SIDES : [...SIDES].reverse()).some(isFree)) text.remove();
    }
  }

  /** Returns the view as the text of an SVG, in the style of paper, with the outlines of all
   * objects. Its width is `SVG_WIDTH`. Fails if there is no picture of the text. */
  async asSvg(): Promise<string> {
    const { picture: { canvas, stage }, size: [across, down] } = this;
    const [width, height] = [SVG_WIDTH, Math.round(SVG_WIDTH * down / across)];
    const view = this.view && { ...this.view, size: [width, height] };
    const data = view && await editor.request<Overlays | null>("pinhole/overlays",
      { only: null, point: null, view });
    const frame = view && await editor.request<Frame | null>("pinhole/frame", { ...LARGEST,
      view: { ...view, size: [SHARPEST * width, SHARPEST * height] }, samples: SAMPLES });
    if (!data || !frame) throw new Error("The text has errors: it has no view from outside.");
    const whole = createSvg("svg", { width, height, viewBox: `0 0 ${width} ${height}` });
    stage.classList.add(INK);
    stage.append(whole);
    this.drawData(whole, data, ofCamera(data), it => it);
    for (const shape of whole.children) {
      const style = getComputedStyle(shape);
      for (const name of STYLE) shape.setAttribute(name, style.getPropertyValue(name));
    }
    // A translucent white rectangle makes the picture pale, since some programs ignore the opacity
    // of images.
    const pale = 1 - Number(getComputedStyle(canvas).opacity);
    whole.prepend(createSvg("image", { width, height, href: `data:image/png;base64,${frame.png}` }),
      createSvg("rect", { width, height, fill: "#ffffff", "fill-opacity": pale }));
    whole.remove();
    stage.classList.remove(INK);
    this.changed(); // the request for the picture may have replaced another one
    return new XMLSerializer().serializeToString(whole);
  }

  /** Handles of the scene's camera, and the first handle of the selected object. */
  private get owned(): OwnedHandle[] {
    const { data } = this;
    if (!data?.camera || !this.isTrue) return [];
    const of = data.objects.filter(it => it.index === selection.index);
    return [...ofCamera(data), ...of.flatMap(it => handlesOf(it).slice(0, 1))
        .map(it => ({ ...it, owner: `Outside, ${it.owner}` }))];
  }

  /** Returns the handle that `element` shows, or null if it shows none. */
  private held(element: Element): Held | null {
    const { handle, object } = element.closest<HTMLElement>(".handle")?.dataset ?? {};
    const found = this.owned.find(it => it.handle === handle && String(it.object) === object);
    return found?.at ? { object: found.object, handle: found.handle, at: found.at } : null;
  }

  private press(event: PointerEvent): void {
    const { fingers, picture, picture: { stage } } = this;
    if (!fingers.press(event)) return;
    tools.held = event;
    const at = picture.toPicture(picture.local(event));
    const held = this.held(event.target as Element);
    if (held !== null && event.button === 0) {
      fingers.cancelFirst = dragWith(event, at, () => held, this);
      return;
    }
    // The left button drags an object if the pointer is over one, and turns the view otherwise.
    // `isObject` is null until the server has answered which object is there.
    let isObject = event.button === 0 ? null : false;
    const hold = async () => {
      const found = await fingers.isAlone
        ? await grab(at, this.view, it => it !== null && it.kind !== "checkerboard") : null;
      isObject = found !== null;
      // The pointer turns the view. The drag, which would change the text, is cancelled.
      if (!isObject) cancel();
      return found;
    };
    const cancel = isObject === null ? dragWith(event, at, hold, this) : () => {};
    const before = { view: this.view, isChosen: this.isChosen, isInView: this.sawCamera };
    let last: Point = [event.clientX, event.clientY];
    const move = ({ clientX, clientY, shiftKey }: PointerEvent) => {
      if (isObject !== false) return;
      const by: Point = [clientX - last[0], clientY - last[1]];
      last = [clientX, clientY];
      if (event.button === 1 || shiftKey) this.pan(by);
      else this.turn([by[0] / stage.clientHeight, by[1] / stage.clientHeight]);
    };
    fingers.cancelFirst = followPointer(event, move, () => {}, () => {
      cancel();
      Object.assign(this, before);
      this.changed();
    });
  }

  private key(event: KeyboardEvent): void {
    const arrow = ARROWS[event.key];
    const held = this.held(event.target as Element);
    tools.held = event;
    // Control with +, − or 0 is a command of the browser, which zooms the page.
    if (event.altKey || event.metaKey || (event.ctrlKey && arrow === undefined)) return;
    if (arrow !== undefined && held !== null) {
      dragByKey(event, arrow, () => new Drag(held.at, () => held, this));
    } else if (arrow !== undefined) this.turn([arrow[0] * KEY_TURN, arrow[1] * KEY_TURN]);
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.25);
    else if (event.key === "-") this.zoom(1.25);
    else if (event.key === "0") this.look(undefined);
    else return;
    event.preventDefault();
  }

  /** Moves the view to an eye and a `lookat` point that the user has chosen. Does nothing if a
   * coordinate is not finite. */
  private move(eye: Vector, lookat: Vector): void {
    if (this.view === null || ![...eye, ...lookat].every(Number.isFinite)) return;
    this.view = { ...this.view, eye, lookat };
    this.isChosen = true;
    this.sawCamera = false;
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
