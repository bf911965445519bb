// The picture: a canvas in an area (the stage) in which it can be panned and zoomed.

import { byId } from "./dom";
import type { Shown } from "./frames";
import type { Point } from "./protocol";

/** Minimum zoom, in screen pixels per pixel, at which pixels are sharp squares; chosen by eye. */
const SQUARES = 3;
const MOST_ZOOM = 64;
/** Margin around the whole picture in its area, in screen pixels, so that its edge is visible. */
const MARGIN = 12;

export class Picture {
  /** Called when the zoom, the position or the size of the picture has changed. */
  onView: () => void = () => {};
  /** Called when the wheel moves the camera. `turned` is 1 for 300 pixels of scrolling. */
  onDolly: (turned: number) => void = () => {};
  onWheel = (turned: number, event: WheelEvent): void => {
    if (event.shiftKey) this.onDolly(turned);
    else this.zoomBy(2 ** -turned, this.local(event));
  };
  size: [number, number] = [1280, 720];
  zoom = 1;

  private left = 0;
  private top = 0;
  private fitted = true;
  private readonly context: CanvasRenderingContext2D;

  constructor(readonly stage: HTMLElement, readonly canvas: HTMLCanvasElement,
    private readonly margin = MARGIN) {
    const context = canvas.getContext("2d", { alpha: false });
    if (context === null) throw new Error("this browser has no canvas");
    this.context = context;
    new ResizeObserver(() => (this.fitted ? this.fit() : this.place())).observe(stage);
    stage.addEventListener("wheel", event => {
      event.preventDefault();
      if (event.buttons !== 0) return; // a drag is under way
      // While the Shift key is held, some browsers report the wheel's movement as `deltaX`, so it
      // is used if `deltaY` is 0.
      this.onWheel((event.deltaY || event.deltaX) / (event.deltaMode === 0 ? 300 : 10), event);
    }, { passive: false });
  }

  show({ bitmap, size, fineness, version }: Shown): void {
    const { canvas } = this;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    this.context.drawImage(bitmap, 0, 0);
    bitmap.close();
    canvas.dataset["fineness"] = fineness;
    canvas.dataset["version"] = String(version);
    if (size[0] !== this.size[0] || size[1] !== this.size[1]) {
      this.size = size;
      this.stage.style.setProperty("--aspect", String(size[0] / size[1]));
      this.fit();
    }
    canvas.dispatchEvent(new CustomEvent("pinhole-frame",
      { bubbles: true, detail: { fineness, version } }));
  }

  /** Whether no picture has been shown yet. */
  get isEmpty(): boolean { return this.canvas.dataset["fineness"] === undefined; }

  /** Converts a point of the picture to screen pixels from the top left corner of its area. */
  toScreen([x, y]: Point): Point { return [this.left + x * this.zoom, this.top + y * this.zoom]; }

  toPicture([x, y]: Point): Point {
    return [(x - this.left) / this.zoom, (y - this.top) / this.zoom];
  }

  /** Returns an event's position, in screen pixels from the top left corner of the stage. */
  local(event: { clientX: number; clientY: number }): Point {
    const { left, top } = this.stage.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  /** SVG transform from pixels of the picture to screen pixels. */
  get matrix(): string { return `matrix(${this.zoom} 0 0 ${this.zoom} ${this.left} ${this.top})`; }

  /** Zooms so that the whole picture is visible, as large as possible. */
  fit(): void {
    this.center(this.fitting);
    this.fitted = true;
  }

  /** Zoom at which the whole picture is visible, as large as possible. */
  get fitting(): number {
    const { clientWidth, clientHeight } = this.stage;
    const [width, height] = this.size;
    return Math.max(0.01, Math.min((clientWidth - 2 * this.margin) / width,
      (clientHeight - 2 * this.margin) / height));
  }

  /** Zooms so that one pixel of the picture is one pixel of the screen. */
  actualSize(): void { this.center(1 / devicePixelRatio); }

  zoomBy(factor: number, about?: Point): void {
    about ??= [this.stage.clientWidth / 2, this.stage.clientHeight / 2];
    const held = this.toPicture(about);
    this.zoom = Math.min(MOST_ZOOM, Math.max(0.02, this.zoom * factor));
    const [x, y] = this.toScreen(held);
    this.panBy(about[0] - x, about[1] - y);
  }

  panBy(dx: number, dy: number): void {
    this.fitted = false;
    this.left += dx;
    this.top += dy;
    this.place();
  }

  /** Centres the picture in its area, at a zoom given in screen pixels per pixel. */
  private center(zoom: number): void {
    const [width, height] = this.size;
    this.zoom = zoom;
    const [x, y] = this.toScreen([width / 2, height / 2]);
    this.panBy(this.stage.clientWidth / 2 - x, this.stage.clientHeight / 2 - y);
  }

  private place(): void {
    const [width, height] = this.size.map(it => `${it * this.zoom}px`);
    const imageRendering = this.zoom >= SQUARES ? "pixelated" : "auto";
    const transform = `translate(${this.left}px, ${this.top}px)`;
    Object.assign(this.canvas.style, { width, height, transform, imageRendering });
    this.onView();
  }
}

export const picture = new Picture(byId("stage"), byId("canvas"));
