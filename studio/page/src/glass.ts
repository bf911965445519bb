// The glass: one pixel enlarged, with its samples by a chosen method, its exact colour, and a chart
// of its errors by all methods.

import { inAddress } from "./address";
import { showPart } from "./dock";
import { byId, create, createSvg, fromBase64, newestOf, remember, remembered } from "./dom";
import { editor } from "./editor";
import { pointedAt } from "./hover";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Glass, Point, Samples } from "./protocol";
import { say } from "./status";
import { setText } from "./visible";

/** Numbers of samples that can be chosen, those of the chart. */
const COUNTS = [1, 4, 16, 64, 256];
/** Methods in the order in which a key chooses them. */
const METHODS = ["regular", "random", "jittered", "n_rooks", "multi_jittered", "hammersley",
  "halton", "sobol", "scatter"];
/** Size of the chart, in units of its SVG, and its margins for labels. */
const CHART = { width: 340, height: 160, left: 50, right: 104, top: 8, bottom: 30 };
/** Error below which the chart has no scale. It is far below what 8 bits can show. */
const LEAST_ERROR = 1e-5;

class PixelGlass {
  /** Column and row of the pixel under the glass; null if the glass is hidden. */
  private pixel: Point | null = null;
  private data: { glass: Glass; samples: Samples } | null = null;
  private readonly section = byId("glass");
  private readonly method = byId<HTMLSelectElement>("glass-method");
  private readonly count = byId<HTMLSelectElement>("glass-count");

  constructor() {
    for (const name of METHODS) this.method.append(create("option", "", name));
    for (const count of COUNTS) this.count.append(create("option", "", String(count)));
    this.method.value = "multi_jittered";
    this.count.value = "16";
    for (const choice of [this.method, this.count])
      choice.addEventListener("change", () => this.changed());
    const isOld = (layer: string) => layer === "samples" || layer === "grid";
    const layers = (remembered("layers") ?? "").split(" ");
    // The glass has taken the place of two layers. If one of them was shown, the glass opens with
    // the first picture.
    if (layers.some(isOld) || (inAddress("show") ?? "").split(",").some(isOld)) {
      remember("layers", layers.filter(it => !isOld(it)).join(" "));
      picture.canvas.addEventListener("pinhole-frame", () => this.pin(), { once: true });
    }
    byId("glass-pin").addEventListener("click", () => this.pin());
    byId("glass-hide").addEventListener("click", () => this.show(null));
    byId("glass-next").addEventListener("click", () => step(this.method, 1));
    byId("glass-fewer").addEventListener("click", () => step(this.count, -1));
    byId("glass-more").addEventListener("click", () => step(this.count, 1));
  }

  /** Puts the pixel under the pointer, or else the middle one, under the glass. If it is there
   * already, hides the glass. */
  private pin(): void {
    const { size } = picture;
    const at = pointedAt() ?? (this.pixel === null ? [size[0] / 2, size[1] / 2] : this.pixel);
    const inside = ([0, 1] as const).map(axis => at[axis] >= 0 && at[axis] < size[axis]);
    if (!inside.every(Boolean)) return say("Point at a pixel of the picture.", "warning");
    const pixel: Point = [Math.floor(at[0]), Math.floor(at[1])];
    this.show(String(pixel) === String(this.pixel) ? null : pixel);
  }

  show(pixel: Point | null): void {
    this.pixel = pixel;
    showPart(this.section, pixel !== null);
    overlays.pin(pixel);
    if (pixel === null && document.activeElement === document.body) picture.stage.focus();
    this.changed();
  }

  /** Asks anew about the pixel, because the text or what is chosen has changed. */
  changed(): void { if (this.pixel !== null) void this.refresh(); }

  private readonly refresh = newestOf<void>(async () => {
    const { pixel } = this;
    if (pixel === null || editor.uri === "") return;
    const [width, height] = picture.size;
    if (pixel[0] >= width || pixel[1] >= height) return this.show(null);
    const [method, count] = [this.method.value, Number(this.count.value)];
    const glass = await editor.ask<Glass>("pinhole/glass", { pixel });
    const samples = await editor.ask<Samples>("pinhole/samples", { pixel, method, count });
    setText(byId("glass-note"), glass && samples ? "" : "The text has errors.");
    if (glass === null || samples === null || this.pixel !== pixel) return;
    this.data = { glass, samples };
    await this.draw();
  });

  private async draw(): Promise<void> {
    if (this.data === null || this.pixel === null) return;
    const { glass, samples } = this.data;
    setText(byId("glass-pixel"), this.pixel.join(", "));
    const canvas = byId<HTMLCanvasElement>("glass-canvas");
    const bitmap = await createImageBitmap(new Blob([fromBase64(glass.png)]));
    canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
    bitmap.close();
    const radius = Math.min(0.035, Math.max(0.012, 0.2 / Math.sqrt(samples.points.length || 1)));
    byId<HTMLElement & SVGElement>("glass-points").replaceChildren(...samples.points.map(
      ([cx, cy], i) => createSvg("circle", { cx, cy, r: radius, fill: samples.colors[i] ?? "" })));
    this.tabulate(glass, samples);
    byId("glass-chart").replaceChildren(...chart(glass, this.method.value,
      Number(this.count.value)));
  }

  /** Fills the table: what the samples see and what is seen exactly, and both means. */
  private tabulate({ seen, mean, color, bound }: Glass, samples: Samples): void {
    const total = samples.colors.length;
    const rows = seen.slice(0, 4).map(it => {
      const count = samples.colors.filter(color => color === it.color).length;
      const label = cell(it.label ?? "");
      label.prepend(swatch(it.color));
      return row(label, cell(total === 0 ? "–" : percent(count / total)), cell(percent(it.share)));
    });
    const off = Math.sqrt([0, 1, 2].reduce((sum, i) =>
      sum + ((samples.mean[i] ?? 0) - (mean[i] ?? 0)) ** 2, 0) / 3);
    const means = [samples.color, color].map(mean => {
      const colored = cell(mean);
      colored.prepend(swatch(mean));
      return colored;
    });
    byId("glass-table").replaceChildren(...rows, row(cell("mean"), ...means));
    const least = bound === 0 ? "" : `; the exact mean, by at most ${bound.toExponential(0)}`;
    const error = off < LEAST_ERROR ? "right" : `off by ${off.toPrecision(2)} of 1 in linear light`;
    setText(byId("glass-error"), `The mean of the samples is ${error}${least}.`);
  }
}

/** Chooses the next entry of a list, or the one before; after the last, the first again. */
function step(select: HTMLSelectElement, by: number): void {
  const { length } = select.options;
  const wraps = select.id === "glass-method";
  const next = select.selectedIndex + by;
  select.selectedIndex = wraps ? (next + length) % length : Math.max(0, Math.min(length - 1, next));
  select.dispatchEvent(new Event("change"));
}

const percent = (share: number) => `${(100 * share).toFixed(1)} %`;

const cell = (text: string) => create("td", "", text);

function row(...cells: HTMLElement[]): HTMLTableRowElement {
  const row = create("tr");
  row.append(...cells);
  return row;
}

/** Returns a small square of the colour `color`. */
function swatch(color: string): HTMLElement {
  const swatch = create("span", "swatch");
  swatch.style.background = color;
  return swatch;
}

/** Draws the chart: errors against samples, both on logarithmic scales. */
function* chart({ errors, counts }: Glass, chosen: string, count: number): Iterable<SVGElement> {
  const { width, height, left, right, top, bottom } = CHART;
  const all = errors.flatMap(it => it.typical).filter(it => it >= LEAST_ERROR);
  const text = (at: Point, anchor: string, content: string, kind = "") => {
    const element = createSvg("text", { x: at[0], y: at[1], "text-anchor": anchor, class: kind });
    setText(element, content);
    return element;
  };
  if (all.length === 0) {
    return yield text([width / 2, height / 2], "middle", "Every sample is right in this pixel.");
  }
  const high = Math.ceil(Math.log10(Math.max(0.1, ...all)));
  const low = Math.min(high - 1, Math.floor(Math.log10(Math.min(0.1, ...all))));
  const last = Math.log2(counts.at(-1) ?? 2);
  const x = (n: number) => left + (width - left - right) * Math.log2(n) / last;
  const y = (error: number) => top + (height - top - bottom)
    * Math.min(1, (high - Math.log10(Math.max(error, 1e-300))) / (high - low));
  for (let power = high; power >= low; power--) {
    const at = y(10 ** power);
    yield createSvg("path", { d: `M${left} ${at}H${width - right}`, class: "scale" });
    yield text([left - 6, at + 4], "end", power < -3 ? `1e${power}` : String(10 ** power));
  }
  for (const n of counts) yield text([x(n), height - bottom + 14], "middle", String(n));
  yield text([(left + width - right) / 2, height - 3], "middle", "samples");
  for (const { method, typical } of errors) {
    if (method === chosen) continue;
    const d = typical.map((error, i) => `${i === 0 ? "M" : "L"}${x(counts[i] ?? 1)} ${y(error)}`);
    yield createSvg("path", { d: d.join(""), class: "method" });
  }
  const found = errors.find(it => it.method === chosen);
  if (found === undefined) return;
  const d = found.typical.map((error, i) =>
    `${i === 0 ? "M" : "L"}${x(counts[i] ?? 1)} ${y(error)}`);
  yield createSvg("path", { d: d.join(""), class: "method chosen" });
  yield text([width - right + 6, y(found.typical.at(-1) ?? 1) + 4], "start", chosen, "chosen");
  for (const [i, error] of found.own.entries()) {
    const n = counts[i] ?? 1;
    yield createSvg("circle", { cx: x(n), cy: y(error), r: n === count ? 5 : 3, class: "own" });
  }
}

export const glass = new PixelGlass();
