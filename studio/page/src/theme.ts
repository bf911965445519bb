// Dark or light: as the system has it, until one chooses.

import { Compartment, type Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { byId, remember, remembered } from "./dom";
import { setText } from "./visible";

const compartment = new Compartment();
const systemIsDark = matchMedia("(prefers-color-scheme: dark)");

function isDark(): boolean {
  return (remembered("theme") ?? (systemIsDark.matches ? "dark" : "light")) === "dark";
}

/** The editor's part of the theme; all colours are variables of studio.css. */
export function themeExtension(): Extension {
  return compartment.of(EditorView.darkTheme.of(isDark()));
}

export function followTheme(view: EditorView): void {
  const button = byId("theme");
  const apply = () => {
    const dark = isDark();
    document.documentElement.dataset["theme"] = dark ? "dark" : "light";
    setText(button, dark ? "Light" : "Dark");
    button.setAttribute("aria-label", dark ? "Light colours" : "Dark colours");
    view.dispatch({ effects: compartment.reconfigure(EditorView.darkTheme.of(dark)) });
  };
  button.addEventListener("click", () => {
    remember("theme", isDark() ? "light" : "dark");
    apply();
  });
  systemIsDark.addEventListener("change", apply);
  apply();
}
