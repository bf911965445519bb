// The layout: the divider between text and picture, tabs on a phone, the menus, and the theme.

import { Compartment } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { byId, followPointer, remember, remembered } from "./dom";
import { editor } from "./editor";
import { panel } from "./panel";
import { picture } from "./picture";
import { setText } from "./visible";

/** Minimum width or height of the text and of the picture, in % of the page. With a smaller value,
 * the text or the picture could become too small to use. */
const LEAST = 20;
const MOST = 80;

const divider = byId("divider");
const panes = byId("panes");
const isNarrow = matchMedia("(max-width: 760px), (max-aspect-ratio: 1)");
// The text's share of the page is stored separately for text beside the picture and text below it.
const storedShare = () => isNarrow.matches ? { key: "text-below", usual: 30 }
  : { key: "text-share", usual: 42 };
const share = (percent: number) => {
  const bounded = Math.round(Math.min(MOST, Math.max(LEAST, percent)));
  panes.style.setProperty("--text-share", `${bounded}%`);
  divider.setAttribute("aria-valuenow", String(bounded));
  remember(storedShare().key, String(bounded));
};
const orient = () => {
  divider.setAttribute("aria-orientation", isNarrow.matches ? "horizontal" : "vertical");
  share(Number(remembered(storedShare().key) ?? storedShare().usual));
};
isNarrow.addEventListener("change", orient);
orient();
divider.addEventListener("pointerdown", event => {
  divider.setPointerCapture(event.pointerId);
  event.preventDefault();
  const { left, top, width, height } = panes.getBoundingClientRect();
  // On a narrow screen, the text is below the picture, so the text's part of the height is measured
  // from the bottom.
  const move = ({ clientX, clientY }: PointerEvent) =>
    share(100 * (isNarrow.matches ? 1 - (clientY - top) / height : (clientX - left) / width));
  const before = Number(divider.getAttribute("aria-valuenow"));
  followPointer(event, move, () => {}, () => share(before));
});
divider.addEventListener("keydown", event => {
  const direction = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: 1, ArrowDown: -1 }[event.key];
  if (direction === undefined) return;
  event.preventDefault();
  share(Number(divider.getAttribute("aria-valuenow")) + 2 * direction);
});

// On a phone, tabs choose whether the text or the picture is shown.
const tabs = document.querySelectorAll<HTMLButtonElement>("#tabs button");
const showTab = (tab: string) => {
  panes.dataset["tab"] = tab;
  for (const it of tabs) it.setAttribute("aria-pressed", String(it.dataset["tab"] === tab));
};
for (const it of tabs) it.addEventListener("click", () => showTab(it.dataset["tab"] ?? ""));
// What these buttons open is below the text.
for (const id of ["problems", "lessons"]) byId(id).addEventListener("click", () => showTab("text"));

byId("zoom-in").addEventListener("click", () => picture.zoomBy(2));
byId("zoom-out").addEventListener("click", () => picture.zoomBy(0.5));
byId("zoom-fit").addEventListener("click", () => picture.fit());
byId("zoom-actual").addEventListener("click", () => picture.actualSize());
for (const id of ["keys", "language"]) byId(id).addEventListener("click", () =>
  byId<HTMLDialogElement>(`${id}-dialog`).showModal());

// A menu closes on a click elsewhere, on Escape, and after a choice.
const menus = [...document.querySelectorAll<HTMLDetailsElement>("details.menu")];
const closeMenus = (except?: EventTarget | null) => {
  for (const menu of menus) if (!menu.contains(except as Node | null)) menu.open = false;
};
document.addEventListener("pointerdown", ({ target }) => closeMenus(target));
for (const menu of menus) {
  menu.addEventListener("keydown", event => {
    if (event.key !== "Escape" || !menu.open) return;
    event.preventDefault(); // keys.ts ignores this Escape
    closeMenus();
    menu.querySelector("summary")?.focus();
  });
  menu.addEventListener("click", ({ target }) => {
    if ((target as Element).closest("button, [type=radio]")) closeMenus();
  });
}

// In a panel, the theme is that of VS Code. Otherwise, it follows the system until the user chooses
// a theme. The colours are defined in page.css.
const systemIsDark = matchMedia("(prefers-color-scheme: dark)");
const editorTheme = new Compartment();
const ofPanel = () =>
  document.body.matches(".vscode-light, .vscode-high-contrast-light") ? "light" : "dark";
const colors = () => panel ? ofPanel()
  : remembered("theme") ?? (systemIsDark.matches ? "dark" : "light");
const paint = () => {
  const other = colors() === "dark" ? "Light" : "Dark";
  document.documentElement.dataset["theme"] = colors();
  setText(byId("theme"), other);
  byId("theme").setAttribute("aria-label", `${other} colours`);
  const isDark = EditorView.darkTheme.of(colors() === "dark");
  editor.view.dispatch({ effects: editorTheme.reconfigure(isDark) });
};
byId("theme").addEventListener("click", () => {
  remember("theme", colors() === "dark" ? "light" : "dark");
  paint();
});
systemIsDark.addEventListener("change", paint);
if (panel) new MutationObserver(paint)
  .observe(document.body, { attributeFilter: ["class"] });
editor.extend(editorTheme.of([]));
paint();
