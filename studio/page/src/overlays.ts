// Drawings over the picture: optional layers, and outlines of the selected and the hovered object.

import { byId, createSvg, remember, remembered } from "./dom";
import { picture } from "./picture";
import type { Overlays, Point, Polyline, Samples } from "./protocol";
import { setText } from "./visible";

/** Names of the optional layers. Their checkboxes in the menu have the same names. */
export type Layer = "outlines" | "vanishing" | "horizon" | "axis" | "grid" | "near" | "samples";

const boxes = [...document.querySelectorAll<HTMLInputElement>("#layers [name]")];

/** Minimum zoom at which the pixel grid is drawn, in screen pixels per pixel. Chosen by eye: at a
 * lower zoom, the lines would hide the picture. */
const GRID_ZOOM = 6;
/** Minimum zoom at which samples are drawn, in screen pixels per pixel. Chosen by eye. */
const SAMPLES_ZOOM = 4;
/** Distance of arrows from the border of the picture's area, in screen pixels; chosen by eye. */
const EDGE = 14;

class OverlayLayer {
  /** Overlays of the newest text or, if that has errors, of the last text without errors. */
  data: Overlays | null = null;
  /** Whether `data` belongs to the current text. */
  isTrue = true;
  hovered: number | null = null;
  /** Called when overlays must be drawn that `data` may not contain. */
  onNeed: () => void = () => {};
  selected: number | null = null;
  private samples: { pixel: Point; samples: Samples } | null = null;

  constructor(private readonly svg: SVGElement) {
    const layers = remembered("layers")?.split(" ") ?? [];
    for (const box of boxes) {
      box.checked = layers.includes(box.name);
      box.addEventListener("change", () => {
        remember("layers", boxes.filter(it => it.checked).map(it => it.name).join(" "));
        this.draw();
        if (box.checked) this.onNeed();
      });
    }
  }

  isOn(layer: Layer): boolean { return boxes.some(it => it.name === layer && it.checked); }

  /** Whether any enabled layer needs data from the server. */
  get needsAny(): boolean { return this.needsAll || this.isOn("horizon") || this.isOn("near"); }

  /** Whether any enabled layer needs data about all objects. */
  get needsAll(): boolean { return this.isOn("outlines") || this.isOn("vanishing"); }

  hover(hovered: number | null): void {
    if (hovered === this.hovered) return;
    this.hovered = hovered;
    this.draw();
    if (hovered !== null && !this.data?.objects.some(it => it.index === hovered)) this.onNeed();
  }

  showSamples(samples: typeof this.samples): void {
    if (samples === null && this.samples === null) return;
    this.samples = samples;
    this.draw();
  }

  draw(): void {
    const { data, svg } = this;
    svg.replaceChildren();
    setText(byId("unseen"), data === null ? "" : [...this.unseen(data)].join(" "));
    if (data === null) return;
    const group = createSvg("g", { transform: picture.matrix });
    svg.append(group);
    const path = (name: string, lines: readonly Polyline[]) => drawLines(group, name, lines);
    if (this.isOn("grid") && picture.zoom >= GRID_ZOOM) path("grid", grid());
    if (this.isOn("near")) for (const it of ["near", "far"] as const) path(it, data[it]);
    if (this.isOn("horizon") && data.horizon !== null) path("horizon", [data.horizon]);
    const vanishing = this.isOn("vanishing") ? data.vanishing : [];
    for (const { axis, lines } of vanishing) path(`axis-${axis}`, lines);
    if (this.isOn("outlines")) for (const { outline } of data.objects) path("outline", outline);
    for (const name of this.isTrue ? ["hovered", "selected"] as const : []) {
      path(`outline ${name}`, data.objects.find(it => it.index === this[name])?.outline ?? []);
    }
    for (const { axis, point } of vanishing) if (point) this.mark(point, `axis-${axis}`, axis);
    if (this.isOn("axis")) this.mark(data.axis, "view-axis", "view axis");
    if (this.isOn("samples")) this.drawSamples();
  }

  /** Marks a point and its coordinates. If it is out of view, an arrow points to it. */
  private mark(point: Point, name: string, text: string): void {
    const [x, y] = picture.toScreen(point);
    const { clientWidth: width, clientHeight: height } = picture.stage;
    const [middleX, middleY] = [width / 2, height / 2];
    // Ratio of the point's distance from the centre to the border's distance from the centre. If it
    // is more than 1, the point is outside of the border.
    const out = Math.max(Math.abs(x - middleX) / (middleX - EDGE),
      Math.abs(y - middleY) / (middleY - EDGE));
    const part = Math.max(1, out);
    const [atX, atY] = [middleX + (x - middleX) / part, middleY + (y - middleY) / part];
    const turn = Math.atan2(y - middleY, x - middleX) * 180 / Math.PI;
    const shape = out > 1 ? { d: "M-16 0H0M-7 -6L0 0L-7 6", transform:
      `translate(${atX} ${atY}) rotate(${turn})` }
      : { d: `M${x - 7} ${y}H${x + 7}M${x} ${y - 7}V${y + 7}`, transform: "" };
    const isRight = atX > width - 200;
    const label = createSvg("text", { x: atX + (isRight ? -12 : 12), class: `mark ${name}`,
      y: Math.max(16, atY - 9), "text-anchor": isRight ? "end" : "start" });
    setText(label, `${text} (${point.map(it => Math.round(it)).join(", ")})`);
    this.svg.append(...twice(shape, name), label);
  }

  /** Yields messages that say why enabled layers are not visible. */
  private *unseen(data: Overlays): Generator<string> {
    const { zoom } = picture;
    if (this.isOn("grid") && zoom < GRID_ZOOM) yield "The pixel grid shows when you zoom in.";
    if (this.isOn("horizon") && data.horizon === null) yield "The horizon is not near the picture.";
    if (this.isOn("near") && data.near.length + data.far.length === 0) {
      yield "Near and far cut no checkerboard that is seen.";
    }
    const parallel = this.isOn("vanishing") ? data.vanishing.filter(it => it.point === null) : [];
    for (const { axis } of parallel) yield `Lines along ${axis} stay parallel in this picture.`;
    if (this.isOn("samples") && zoom < SAMPLES_ZOOM) yield "Samples show when you zoom in.";
  }

  private drawSamples(): void {
    if (this.samples === null || picture.zoom < SAMPLES_ZOOM) return;
    const { pixel, samples } = this.samples;
    const [x, y] = picture.toScreen(pixel);
    const size = picture.zoom;
    this.svg.append(createSvg("rect", { x, y, width: size, height: size, class: "line sampled" }));
    samples.points.forEach(([dx, dy], i) => {
      const dot = createSvg("circle", { cx: x + dx * size, cy: y + dy * size,
        r: Math.max(2, Math.min(5, size / 12)), class: "sample" });
      dot.style.fill = samples.colors[i] ?? "";
      this.svg.append(dot);
    });
  }
}

/** Draws lines of the class `name` into a group. */
export function drawLines(group: SVGElement, name: string, lines: readonly Polyline[]): void {
  const d = lines.map(line => `M${line.join("L")}`).join("");
  if (d !== "") group.append(...twice({ d }, name));
}

/** Returns a light line over a dark one. One of them is visible on any background. */
function twice(shape: Record<string, string>, name: string): SVGElement[] {
  return ["under ", ""].map(it => createSvg("path", { ...shape, class: `line ${it}${name}` }));
}

/** Returns the lines of the grid that separate the visible pixels. */
function grid(): Polyline[] {
  const { stage, size } = picture;
  const [left, top] = picture.toPicture([0, 0]);
  const [right, bottom] = picture.toPicture([stage.clientWidth, stage.clientHeight]);
  const [x0, x1] = [Math.max(0, Math.floor(left)), Math.min(size[0], Math.ceil(right))];
  const [y0, y1] = [Math.max(0, Math.floor(top)), Math.min(size[1], Math.ceil(bottom))];
  const lines: Polyline[] = [];
  for (let x = x0; x <= x1; x++) lines.push([[x, y0], [x, y1]]);
  for (let y = y0; y <= y1; y++) lines.push([[x0, y], [x1, y]]);
  return lines;
}

export const overlays = new OverlayLayer(document.querySelector("#lines") as SVGElement);
