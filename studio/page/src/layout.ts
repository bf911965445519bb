// The layout: the divider between text and picture, the zoom buttons, the menus, and the list of
// keys.

import { byId, create, followPointer, remember, remembered } from "./dom";
import { LAYERS, type Layer, type OverlayLayer } from "./overlays";
import type { Picture } from "./picture";

/** How much of the width, or of the height on narrow screens, the text may take up, in per cent. */
const LEAST = 20;
const MOST = 80;

export function layOut(picture: Picture): void {
  const divider = byId("divider");
  const panes = byId("panes");
  const isNarrow = matchMedia("(max-width: 760px), (max-aspect-ratio: 1)");
  const share = (percent: number) => {
    const bounded = Math.round(Math.min(MOST, Math.max(LEAST, percent)));
    panes.style.setProperty("--text-share", `${bounded}%`);
    divider.setAttribute("aria-valuenow", String(bounded));
    remember("text-share", String(bounded));
  };
  const orient = () => (divider.ariaOrientation = isNarrow.matches ? "horizontal" : "vertical");
  isNarrow.addEventListener("change", orient);
  orient();
  share(Number(remembered("text-share") ?? 42));
  divider.addEventListener("pointerdown", event => {
    divider.setPointerCapture(event.pointerId);
    event.preventDefault();
    const { left, top, width, height } = panes.getBoundingClientRect();
    // On narrow screens the picture is above the text.
    const move = ({ clientX, clientY }: PointerEvent) =>
      share(100 * (isNarrow.matches ? 1 - (clientY - top) / height : (clientX - left) / width));
    followPointer(event, move, () => {});
  });
  divider.addEventListener("keydown", event => {
    const direction = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (direction === undefined) return;
    event.preventDefault();
    share(Number(divider.getAttribute("aria-valuenow")) + 2 * direction);
  });

  // A phone has room for one of the two.
  const tabs = document.querySelectorAll<HTMLButtonElement>("#tabs button");
  const show = (tab: string) => {
    panes.dataset["tab"] = tab;
    for (const it of tabs) it.setAttribute("aria-pressed", String(it.dataset["tab"] === tab));
  };
  for (const it of tabs) it.addEventListener("click", () => show(it.dataset["tab"] ?? ""));
  byId("problems").addEventListener("click", () => show("text"));

  byId("zoom-in").addEventListener("click", () => picture.zoomBy(2));
  byId("zoom-out").addEventListener("click", () => picture.zoomBy(0.5));
  byId("zoom-fit").addEventListener("click", () => picture.fit());
  byId("zoom-actual").addEventListener("click", () => picture.actualSize());
  byId("keys").addEventListener("click", () => byId<HTMLDialogElement>("keys-dialog").showModal());

  // A menu closes by a click elsewhere, by Escape, and when something in it was chosen.
  for (const menu of document.querySelectorAll<HTMLDetailsElement>("details.menu")) {
    document.addEventListener("pointerdown", event => {
      if (!menu.contains(event.target as Node)) menu.open = false;
    });
    menu.addEventListener("keydown", event => {
      if (event.key !== "Escape") return;
      menu.open = false;
      menu.querySelector("summary")?.focus();
    });
    const close = () => (menu.open = false);
    for (const button of menu.querySelectorAll("button")) button.addEventListener("click", close);
  }
}

/** The menu of what can be drawn over the picture. */
export function offerLayers(overlays: OverlayLayer): void {
  for (const [layer, name] of Object.entries(LAYERS) as [Layer, string][]) {
    const label = create("label");
    const box = create("input");
    box.type = "checkbox";
    box.name = layer;
    box.checked = overlays.isOn(layer);
    box.addEventListener("change", () => overlays.turn(layer, box.checked));
    label.append(box, ` ${name}`);
    byId("layers").append(label);
  }
}
