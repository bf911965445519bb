// Sliders for all numbers and angles defined by `let`. A slider can play: it then moves by itself.
// At most one slider plays at a time.

import type { ChangeDesc } from "@codemirror/state";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { NumberSlider, literalAt, written } from "./numbers";
import type { Slider } from "./protocol";
import { render } from "./share";
import { setText } from "./visible";

/** Time in which a playing slider moves from one end to the other, in ms. Chosen by eye: with a
 * shorter time, a change would be hard to follow. */
const PLAY = 4000;
/** Maximum number of pictures in a recording, which lasts `PLAY`. Each picture is rendered with all
 * samples. With more pictures, the recording would be smoother, but take longer to make. */
const PICTURES = 60;

type Row = ReturnType<typeof createRow>;
let rows: Row[] = [];
let playing: Row | null = null;

/** Adapts the sliders' offsets in the text to a change of the text, and shows the new numbers. */
export function mapSliders(changes: ChangeDesc): void {
  for (const row of rows) {
    row.at = changes.mapPos(row.at, -1);
    show(row);
  }
}

function show({ dial, value }: Row): void {
  const found = dial.show();
  const written = found === null ? "" : editor.view.state.sliceDoc(found.from, found.end);
  setText(value, written);
  value.title = written;
}

/** Requests the sliders of the current text. It is called after a pause in changes. */
export async function refreshSliders(): Promise<void> {
  const sliders = await editor.askCurrent<Slider[]>("pinhole/sliders", {});
  // While a slider is being moved, no row is replaced.
  if (sliders === null || rows.some(row => row.dial.turn)) return;
  if (sliders.some(({ name }, i) => rows[i]?.name !== name) || sliders.length < rows.length) {
    rows = sliders.map(({ name }) => createRow(name));
    byId("sliders").replaceChildren(...rows.map(row => row.element));
  }
  byId("sliders").hidden = sliders.length === 0;
  sliders.forEach(({ range, limits, note }, i) => {
    const row = rows[i] as Row;
    setText(row.note, note ?? "");
    row.at = editor.offset(range.start);
    row.dial.limits = limits;
    row.element.classList.toggle("note-only", limits === null);
    show(row);
  });
}

/** Creates the row of a slider. Its field `at` is the offset of the number in the text. */
function createRow(name: string) {
  const dial: NumberSlider = new NumberSlider(() => literalAt(row.at + 1));
  dial.range.setAttribute("aria-label", name);
  dial.range.addEventListener("input", () => { if (playing === row) stop(); });
  const [element, value, note] = [create("div", "slider-row"), create("output"), create("p")];
  const button: HTMLElement = createButton("", "play", () => play(row), `Play ${name}`);
  const recorder: HTMLElement = createButton("", "record", () => void record(name, dial, recorder),
    `Record ${name}`);
  element.append(create("span", "", name), dial.range, value, button, recorder, note);
  const row = { name, at: 0, dial, element, value, button, note };
  return row;
}

/** Stops the slider that is playing, if there is one. */
export function stop(): void {
  const row = playing;
  playing = null;
  if (row === null) return;
  row.button.removeAttribute("aria-pressed");
  row.dial.end();
}

/** Downloads an animation of the scene in which the number runs from one end of its slider to the
 * other. The text does not change. If the slider is being recorded already, cancels the recording.
 */
async function record(name: string, { limits, literal }: NumberSlider, button: Element,
): Promise<void> {
  const found = literal();
  if (button.ariaPressed === "true") return byId("cancel").click();
  if (found === null || limits === null) return;
  button.ariaPressed = "true";
  const { ends: [least, most], step } = limits;
  const last = Math.max(1, Math.min(PICTURES - 1, Math.round((most - least) / step)));
  const values = Array.from({ length: last + 1 }, (_, i) =>
    written(limits, least + Math.round((most - least) * i / last / step) * step));
  const { text } = editor;
  await render("png", "image/png", `-${name}`, { values, time: PLAY,
    before: text.slice(0, found.from), after: text.slice(found.to) });
  button.ariaPressed = null;
}

document.addEventListener("keydown", event => {
  const isRecorded = document.querySelector(".record[aria-pressed=true]") !== null;
  if (event.key !== "Escape" || (playing === null && !isRecorded)) return;
  event.stopPropagation();
  if (isRecorded) byId("cancel").click();
  stop();
}, true);

/** Moves a slider to and fro from its current value. If it is already playing, stops it. */
function play(row: Row): void {
  const isNew = playing !== row;
  stop();
  if (!isNew) return;
  playing = row;
  row.button.setAttribute("aria-pressed", "true");
  const { dial, dial: { range } } = row;
  const [least, most] = [Number(range.min), Number(range.max)];
  let good = dial.literal()?.value ?? Number(range.value);
  const begin = performance.now() - PLAY * (good - least) / (most - least);
  const go = async () => {
    if (playing !== row) return;
    if (frames.dragging !== null && frames.dragging !== dial) return stop();
    const part = ((performance.now() - begin) / PLAY) % 2;
    range.value = String(least + (most - least) * (part > 1 ? 2 - part : part));
    const next = Number(range.value);
    await dial.set(next);
    // If the scene has an error, the number returns to its last valid value, and playing stops.
    const isBroken = await frames.coarse === null;
    if (isBroken && playing === row) await dial.set(good);
    good = next;
    // A drag, Undo or another change of the text also stops playing.
    if (isBroken || frames.dragging !== dial || !dial.turn?.gesture.isAlone) stop();
    else requestAnimationFrame(() => void go());
  };
  void go();
}
