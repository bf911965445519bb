// Helpers of the tests of lessons.

import { readdirSync, readFileSync } from "node:fs";
import { andFinished } from "./helpers.mjs";

const folder = new URL("../../../examples/lessons/", import.meta.url);
export const names = readdirSync(folder).filter(file => /^\d.*\.md$/.test(file)).sort().map(file => file.replace(".md", ""));
export const read = (name, ending) => readFileSync(new URL(`${name}.${ending}`, folder), "utf8");

export const state = page => page.textContent("#lesson-state");

export async function until(page, words) {
  await page.waitForFunction(words => document.querySelector("#lesson-state").textContent.includes(words), words, { timeout: 15_000 });
}

/** Opens a lesson by a click in the list of lessons. */
export async function choose(page, number) {
  if (await page.isHidden("#lesson")) await page.click("#lessons");
  else await page.click("#lesson-list");
  await andFinished(page, () => page.click(`#lesson-body li:nth-child(${number}) button`));
}

/** Returns for each condition of the current step whether it holds, and its description. */
export async function conditions(page) {
  return page.locator(".conditions li").evaluateAll(all => all.map(it => [it.classList.contains("holds"), it.children[1].textContent]));
}

/** Goes to the last step of the lesson. */
export async function last(page) {
  while ((await page.textContent("#lesson-next")) === "Next ▸") await page.click("#lesson-next");
}
