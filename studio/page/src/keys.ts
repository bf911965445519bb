// The keys of the picture: what arrows move, and the choice of tools, views and what drags are held
// to.

import { Drag, type Workbench } from "./drag";
import type { Along, Point } from "./protocol";
import type { Selection } from "./selection";
import type { Status } from "./status";
import { TOOLS, type Tools } from "./tools";

/** How far an arrow key moves, in pixels of the picture; with the control key a tenth of it. */
const KEY_STEP = 10;

/** A pause after which the next arrow key begins another drag, in milliseconds. */
const KEY_PAUSE = 500;

const ARROWS: Record<string, Point> =
  { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Keys {
  space = false;
  private drag: Drag | null = null;
  private pause = 0;

  constructor(private readonly bench: Workbench, private readonly selection: Selection,
    private readonly tools: Tools, private readonly status: Status) {
    const { stage } = bench.picture;
    stage.addEventListener("keydown", event => this.down(event));
    stage.addEventListener("keyup", event => this.up(event));
    stage.addEventListener("focusout", event => {
      // From handle to handle the hands stay on the picture.
      if (event.relatedTarget instanceof Node && stage.contains(event.relatedTarget)) return;
      this.end();
      this.freeSpace();
    });
  }

  end(): void {
    clearTimeout(this.pause);
    this.drag?.end();
    this.drag = null;
  }

  private down(event: KeyboardEvent): void {
    const { key } = event;
    const { picture } = this.bench;
    const arrow = ARROWS[key];
    this.tools.shift = event.shiftKey;
    clearTimeout(this.pause);
    if (arrow === undefined && !["Escape", "Shift", "Control"].includes(key)) this.end();
    if (event.altKey || event.metaKey || (event.ctrlKey && arrow === undefined)) return;
    if (arrow !== undefined) {
      const step = event.ctrlKey ? KEY_STEP / 10 : KEY_STEP;
      this.drag ??= this.begin(event.target as Element);
      this.drag?.by([arrow[0] * step, arrow[1] * step]);
    } else if (key === "Escape") {
      if (this.drag === null) this.selection.select(null);
      this.drag?.cancel();
      this.drag = null;
    } else if (key === " ") {
      this.space = true;
      picture.stage.dataset["space"] = "";
    } else if (key in TOOLS) this.tools.choose(TOOLS[key as keyof typeof TOOLS]);
    else if ("xyz".includes(key)) this.tools.hold(key as Along);
    else if (key === "f") this.tools.hold("floor");
    else if (key === "+" || key === "=") picture.zoomBy(2);
    else if (key === "-") picture.zoomBy(0.5);
    else if (key === "0") picture.fit();
    else if (key === "1") picture.actualSize();
    else return;
    event.preventDefault();
  }

  private up(event: KeyboardEvent): void {
    this.tools.shift = event.shiftKey;
    if (event.key === " ") this.freeSpace();
    // Taps that follow each other are one drag.
    if (event.key in ARROWS) this.pause = setTimeout(() => this.end(), KEY_PAUSE);
  }

  private freeSpace(): void {
    this.space = false;
    delete this.bench.picture.stage.dataset["space"];
  }

  /** What an arrow key drags: the focused handle, else the selected object or the camera. */
  private begin(focused: Element): Drag | null {
    const { tool } = this.tools;
    const { size: [width, height] } = this.bench.picture;
    const isHandle = focused.closest(".handle") !== null;
    if (!isHandle && tool !== "move") {
      // Roll turns about the middle: one has to take hold beside of it.
      const at: Point = [tool === "roll" ? 0.75 * width : width / 2, height / 2];
      return new Drag(this.bench, at, () => ({ object: null, handle: tool, at }));
    }
    const held = this.selection.held(isHandle ? focused : null);
    if (held !== null) return new Drag(this.bench, held.at, () => held);
    this.status.say("Select an object, or choose what the camera does.", "warning");
    return null;
  }
}
