// Drawings over the picture: optional layers, and outlines of the selected and the hovered object.

import { inAddress } from "./address";
import { byId, createSvg, remember, remembered } from "./dom";
import { picture } from "./picture";
import type { Overlays, Point, Polyline } from "./protocol";
import { setText } from "./visible";

/** Names of the optional layers. Their checkboxes in the menu have the same names. */
export type Layer = "outlines" | "vanishing" | "horizon" | "axis" | "near";

const boxes = [...document.querySelectorAll<HTMLInputElement>("#layers [name]")];

/** Distance of arrows from the border of the picture's area, in screen pixels; chosen by eye. */
const EDGE = 14;

class OverlayLayer {
  /** Overlays that the server has sent last; null if it has sent none yet. For a text with errors,
   * it sends none. */
  data: Overlays | null = null;
  /** Whether `data` belongs to the current text. */
  isCurrent = true;
  hovered: number | null = null;
  /** Called when `data` may lack overlays that must be drawn: when a layer is switched on, or when
   * the pointer reaches an object without overlays. */
  onNeed: () => void = () => {};
  selected: number | null = null;
  /** Column and row of the pixel under the glass, which is marked; null if there is none. */
  private pinned: Point | null = null;
  /** Layers that `hideLayers` has hidden, as in `shownLayers`; null if it has hidden none. */
  private hiddenLayers: string | null = null;

  constructor(private readonly svg: SVGElement) {
    const layers = inAddress("show")?.split(",") ?? remembered("layers")?.split(" ") ?? [];
    for (const box of boxes) {
      box.checked = layers.includes(box.name);
      box.addEventListener("change", () => {
        remember("layers", boxes.filter(it => it.checked).map(it => it.name).join(" "));
        this.draw();
        if (box.checked) this.onNeed();
      });
    }
  }

  /** Shows the layers that the page's new address names, if it names any. They are not
   * remembered. */
  showAddressed(): void { this.showLayers(inAddress("show")); }

  /** Hides all layers. `restoreLayers` or a reload shows them again. If the page's address names
   * layers, does nothing. */
  hideLayers(): void {
    if (inAddress("show") !== null) return;
    this.hiddenLayers ??= this.shownLayers;
    this.showLayers("");
  }

  /** Shows the layers again that `hideLayers` has hidden, unless the page's address names others.
   */
  restoreLayers(): void {
    if (inAddress("show") === null) this.showLayers(this.hiddenLayers);
    this.hiddenLayers = null;
  }

  /** Shows only the layers `names`, which commas separate. If `names` is null, does nothing. */
  private showLayers(names: string | null): void {
    if (names === null) return;
    for (const box of boxes) box.checked = names.split(",").includes(box.name);
    this.draw();
    this.onNeed();
  }

  /** Names of the layers that are shown, separated by commas. */
  get shownLayers(): string { return boxes.filter(it => it.checked).map(it => it.name).join(); }

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

  /** Marks a pixel. If `pixel` is null, removes the mark. */
  pin(pixel: Point | null): void {
    this.pinned = pixel;
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
    if (this.pinned !== null) {
      const [x, y] = this.pinned;
      path("pinned", [[[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1], [x, y]]]);
    }
    if (this.isOn("near")) for (const it of ["near", "far"] as const) path(it, data[it]);
    if (this.isOn("horizon") && data.horizon !== null) path("horizon", [data.horizon]);
    const vanishing = this.isOn("vanishing") ? data.vanishing : [];
    for (const { axis, lines } of vanishing) path(`axis-${axis}`, lines);
    if (this.isOn("outlines")) for (const { outline } of data.objects) path("outline", outline);
    for (const name of this.isCurrent ? ["hovered", "selected"] as const : []) {
      path(`outline ${name}`, data.objects.find(it => it.index === this[name])?.outline ?? []);
    }
    for (const { axis, point } of vanishing) if (point) this.mark(point, `axis-${axis}`, axis);
    if (this.isOn("axis")) this.mark(data.axis, "view-axis", "view axis");
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
    const isRight = atX > middleX;
    const label = createSvg("text", { x: atX + (isRight ? -12 : 12), class: `mark ${name}`,
      y: Math.max(16, atY - 9), "text-anchor": isRight ? "end" : "start" });
    setText(label, `${text} (${point.map(it => Math.round(it)).join(", ")})`);
    this.svg.append(...twice(shape, name), label);
  }

  /** Yields messages that say why enabled layers are not visible. */
  private *unseen(data: Overlays): Generator<string> {
    if (this.isOn("horizon") && data.horizon === null) yield "The horizon is not near the picture.";
    if (this.isOn("near") && data.near.length + data.far.length === 0) {
      yield "Near and far cut no checkerboard that is seen.";
    }
    const parallel = this.isOn("vanishing") ? data.vanishing.filter(it => it.point === null) : [];
    for (const { axis } of parallel) yield `Lines along ${axis} stay parallel in this picture.`;
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

export const overlays = new OverlayLayer(document.querySelector("#lines") as SVGElement);
