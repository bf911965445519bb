// The glass: one pixel enlarged, with its samples by a chosen method, its exact colour, and a chart
// of its errors by all methods.

import { inAddress } from "./address";
import { showPart } from "./dock";
import { byId, create, createSvg, fromBase64, newestOf, remember, remembered } from "./dom";
import { editor } from "./editor";
import { place, pointedAt } from "./hover";
import { overlays } from "./overlays";
import { picture } from "./picture";
import { isSuperseded, type Glass, type Point, type Samples } from "./protocol";
import { say, unsay } from "./status";
import { setText } from "./visible";

/** Value of the first entry of the lists of methods and of numbers of samples. It means the scene's
 * own method or number. */
const OF_SCENE = "as the scene";
/** Size of the chart and of the margins around its plot, in units of its SVG. The margins contain
 * the labels; smaller ones would cut them off. */
const CHART = { width: 340, height: 160, left: 50, right: 104, top: 8, bottom: 30 };
/** Error in linear light (from 0 to 1) below which the mean of the samples is called right. The
 * scale of the chart ignores smaller errors. The value is far below a step of 8 bits. */
const LEAST_ERROR = 1e-5;
/** Maximum number of colours in the table, one row each. If there are more, the last row is their
 * sum. */
const ROWS = 4;
const NOWHERE = "Point at a pixel of the picture, then press g.";

class PixelGlass {
  /** Column and row of the pixel under the glass; null if the glass is hidden. */
  private pixel: Point | null = null;
  /** Position of the pointer, in screen pixels, when the key g was pressed last; null if it was not
   * over the picture. */
  private place: Point | null = null;
  /** Number of the samples that are shown. */
  private total = 0;
  private readonly section = byId("glass");
  private readonly method = byId<HTMLSelectElement>("glass-method");
  private readonly count = byId<HTMLSelectElement>("glass-count");

  constructor() {
    this.method.append(new Option("method: scene's", OF_SCENE));
    this.count.append(new Option("samples: scene's", OF_SCENE));
    for (const choice of [this.method, this.count])
      choice.addEventListener("change", () => this.changed());
    const isOld = (layer: string) => layer === "samples" || layer === "grid";
    const layers = (remembered("layers") ?? "").split(" ");
    // Links and settings from earlier versions of the page may contain the layers `samples` and
    // `grid`, which the glass has replaced. If they do, the glass opens with the first picture.
    if (layers.some(isOld) || (inAddress("show") ?? "").split(",").some(isOld)) {
      remember("layers", layers.filter(it => !isOld(it)).join(" "));
      picture.canvas.addEventListener("pinhole-frame", () => this.pin(), { once: true });
    }
    byId("glass-pin").addEventListener("click", () => this.pin());
    byId("glass-hide").addEventListener("click", () => this.show(null));
    byId("glass-next").addEventListener("click", () => {
      if (this.pixel === null) return;
      this.method.selectedIndex = (this.method.selectedIndex + 1) % this.method.options.length;
      this.changed();
    });
    byId("glass-fewer").addEventListener("click", () => this.take((n, now) => n < now, -1));
    byId("glass-more").addEventListener("click", () => this.take((n, now) => n > now, 0));
  }

  /** Shows the pixel under the pointer; without a pointer, the middle pixel. If this pixel is shown
   * already, or if the pointer has not moved since the last call, hides the glass. The position of
   * the pointer is compared, too, because the picture may shrink when the glass appears, so that
   * the pointer is then over another pixel. */
  private pin(): void {
    const { size } = picture;
    const isStill = place !== null && String(place) === String(this.place);
    this.place = place;
    if (this.pixel !== null && isStill) return this.show(null);
    const at = pointedAt() ?? (this.pixel === null ? [size[0] / 2, size[1] / 2] : this.pixel);
    const inside = ([0, 1] as const).map(axis => at[axis] >= 0 && at[axis] < size[axis]);
    if (!inside.every(Boolean)) return say(NOWHERE, "warning");
    unsay(NOWHERE);
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

  /** Chooses a number of samples from the list. `isMeant` says whether a number may be chosen; its
   * second argument is the present number. Of these numbers, chooses the first (`which` is 0) or
   * the last (`which` is −1). */
  private take(isMeant: (count: number, now: number) => boolean, which: number): void {
    if (this.pixel === null) return;
    const now = this.count.selectedIndex === 0 ? this.total : Number(this.count.value);
    const counts = [...this.count.options].map(it => Number(it.value));
    const next = counts.filter(it => isMeant(it, now)).at(which);
    if (next === undefined) return;
    this.count.value = String(next);
    this.changed();
  }

  /** Requests the data of the pixel again after a change of the text, the method or the number of
   * samples. */
  changed(): void { if (this.pixel !== null) void this.refresh(); }

  private readonly refresh = newestOf<void>(async () => {
    const { pixel } = this;
    if (pixel === null || editor.uri === "") return;
    const [width, height] = picture.size;
    if (pixel[0] >= width || pixel[1] >= height) return this.show(null);
    const chosen = (list: HTMLSelectElement) => list.selectedIndex === 0 ? null : list.value;
    const [method, count] = [chosen(this.method), chosen(this.count)];
    let why = "The text has errors.";
    const failed = (error: Error) => (why = isSuperseded(error) ? "" : error.message, null);
    const glass = await editor.request<Glass | null>("pinhole/glass", { pixel }).catch(failed);
    const samples = await editor.request<Samples | null>("pinhole/samples",
      { pixel, method, count: count && Number(count) }).catch(failed);
    setText(byId("glass-note"), glass && samples ? "" : why);
    if (glass === null || samples === null || this.pixel !== pixel) return;
    if (this.method.options.length === 1) {
      for (const it of glass.errors) this.method.append(create("option", "", it.method));
      for (const it of glass.counts) this.count.append(create("option", "", String(it)));
    }
    this.total = samples.points.length;
    await this.draw(pixel, glass, samples, method ?? glass.method);
  });

  private async draw(pixel: Point, glass: Glass, samples: Samples, method: string): Promise<void> {
    setText(byId("glass-pixel"), pixel.join(", "));
    const canvas = byId<HTMLCanvasElement>("glass-canvas");
    const bitmap = await createImageBitmap(new Blob([fromBase64(glass.png)]));
    canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
    bitmap.close();
    const radius = Math.min(0.035, Math.max(0.012, 0.2 / Math.sqrt(samples.points.length || 1)));
    byId<HTMLElement & SVGElement>("glass-points").replaceChildren(...samples.points.map(
      ([cx, cy], i) => createSvg("circle", { cx, cy, r: radius, fill: samples.colors[i] ?? "" })));
    this.tabulate(glass, samples);
    byId("glass-chart").replaceChildren(...chart(glass, method, samples.points.length));
  }

  /** Fills the table: for each colour, its fraction of the samples and its exact fraction of the
   * pixel. Below are the mean of the samples and the exact mean. */
  private tabulate({ seen, mean, color, bound }: Glass, samples: Samples): void {
    const total = samples.colors.length;
    const listed = seen.slice(0, seen.length > ROWS ? ROWS - 1 : ROWS);
    const others = seen.slice(listed.length);
    const rest = { color: "", label: `${others.length} others`,
      share: others.reduce((sum, it) => sum + it.share, 0) };
    const rows = (others.length === 0 ? listed : [...listed, rest]).map(it => {
      const shown = it === rest ? others : [it];
      const count = samples.colors.filter(is => shown.some(({ color }) => color === is)).length;
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
