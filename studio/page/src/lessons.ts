// Lessons in the slot: a list, and the steps of the lesson that is open. A lesson's conditions are
// judged by the engine after each change of the scene. The page's address names the open lesson, so
// a reload opens it again.

import { marked, type Token, type Tokens } from "marked";
import { inAddress } from "./address";
import { byId, create, createButton, remember, remembered } from "./dom";
import { editor } from "./editor";
import { files } from "./files";
import { Refusal, type Judged, type LessonText } from "./protocol";
import { sanitized } from "./sanitize";
import { say } from "./status";
import { setText } from "./visible";

/** Delay after a change, in ms, before the conditions are judged. With a shorter one, each step of
 * a drag would be judged, which would delay its pictures. */
const REST = 150;
const KEY = "lesson";

/** A lesson, with its title and the Markdown of its steps. */
interface Lesson extends LessonText { title: string; steps: Token[][] }

/** Lesson 0 is that of the host, if it has one. The others are those of the page. */
const lessons: (Lesson | null)[] = [null, ...LESSONS.map(read)];

const panel = byId("lesson");
const title = byId("lesson-title");
const body = byId("lesson-body");
const state = byId("lesson-state");
const [back, on] = [byId<HTMLButtonElement>("lesson-back"), byId<HTMLButtonElement>("lesson-next")];

let current: Lesson | null = null;
let step = 0;
/** Whether the panel shows the list of all lessons. */
let isList = true;
/** The engine's last answer about the current lesson. */
let judged: Judged | null = null;
const solved = new Set(remembered("solved")?.split("\n"));

/** Splits a lesson's Markdown into its title and its steps, which begin with headings `##`. */
function read(lesson: LessonText): Lesson {
  const steps: Token[][] = [[]];
  let title = lesson.name;
  for (const token of marked.lexer(lesson.text)) {
    const depth = token.type === "heading" ? (token as Tokens.Heading).depth : 0;
    if (depth === 1) title = (token as Tokens.Heading).text;
    else if (depth === 2) steps.push([{ ...token, depth: 3 } as Token]);
    else if (token.type !== "space") steps.at(-1)?.push(token);
  }
  return { ...lesson, title, steps: steps.filter(it => it.length > 0) };
}

/** Handles the start of the page. `own` is the host's lesson. If the page has another scene than a
 * new one, the lesson is shown beside it; otherwise, the lesson's scene replaces it. */
export function startLessons(own: LessonText | null | undefined, isNew: boolean): void {
  if (own != null) lessons[0] = read(own);
  if (inAddress(KEY) !== null) followAddress();
  else if (lessons[0]) open(lessons[0], isNew);
}

/** Opens the lesson that the page's address names, or closes the open one if it names none. */
export function followAddress(): void {
  const named = inAddress(KEY);
  if (named === null) return close();
  const lesson = lessons[Number(named)];
  if (lesson) open(lesson, true);
  else say(`There is no lesson ${named}.`, "warning");
}

/** Opens a lesson. `withScene` says whether its scene replaces that of the page. A scene in the
 * page's address stays. */
function open(lesson: Lesson, withScene: boolean): void {
  if (lesson !== current) {
    [current, step, judged] = [lesson, 0, null];
    if (withScene && inAddress("scene") === null) files.start(`${lesson.name}.scn`, lesson.start);
  }
  isList = false;
  show();
  lessonChanged();
}

function close(): void {
  current = null;
  isList = true;
  panel.hidden = true;
  byId("lessons").setAttribute("aria-expanded", "false");
}

let timer: ReturnType<typeof setTimeout>;

/** Has the conditions judged after a pause in changes of the scene or the lesson. */
export function lessonChanged(): void {
  clearTimeout(timer);
  if (current !== null) timer = setTimeout(() => void judge(), REST);
}

async function judge(): Promise<void> {
  const [lesson, { doc }] = [current, editor.view.state];
  if (lesson === null || editor.uri === "") return;
  try {
    const { text, start } = lesson;
    const answer = await editor.request<Judged | null>("pinhole/lesson", { lesson: text, start });
    // The answer is null if the text has errors. Then the marks stay as they are.
    if (answer === null || lesson !== current || editor.view.state.doc !== doc) return;
    const isNew = answer.holds && !judged?.holds;
    judged = answer;
    if (answer.holds) solved.add(lesson.name);
    if (isNew) remember("solved", [...solved].join("\n"));
    showConditions();
  } catch (error) {
    if (error instanceof Refusal && lesson === current) setText(state, error.message);
  }
}

/** Shows the current step, or the list of all lessons. */
function show(): void {
  panel.hidden = false;
  byId("lessons").setAttribute("aria-expanded", "true");
  panel.classList.toggle("is-list", isList);
  if (isList || current === null) {
    setText(title, "Lessons");
    body.replaceChildren(list());
    return setText(state, "");
  }
  const { steps } = current;
  const number = lessons.indexOf(current);
  setText(title, number === 0 ? current.title : `${number}. ${current.title}`);
  setText(byId("lesson-step"), `step ${step + 1} of ${steps.length}`);
  body.replaceChildren(...(steps[step] ?? []).map(token => isCheck(token)
    ? create("ul", "conditions") : Object.assign(create("div"),
      { innerHTML: sanitized(marked.parser([token])) })));
  body.scrollTop = 0;
  back.disabled = step === 0;
  const isLast = step === steps.length - 1;
  setText(on, isLast ? "Next lesson ▸" : "Next ▸");
  on.disabled = isLast && following() === null;
  showConditions();
}

const isCheck = (token: Token) =>
  token.type === "code" && /^check\b/.test((token as Tokens.Code).lang ?? "");

function list(): HTMLElement {
  const all = create("ol");
  lessons.forEach((lesson, i) => {
    if (lesson === null) return;
    const isSolved = solved.has(lesson.name);
    const item = create("li");
    item.append(createButton(`${i === 0 ? "" : `${i}. `}${lesson.title}${isSolved ? " ✓" : ""}`,
      "", () => choose(i), isSolved ? `${lesson.title}, solved` : null));
    all.append(item);
  });
  return all;
}

/** Opens a lesson by the page's address, so that Back leads to what was there before. */
function choose(i: number): void {
  history.pushState(null, "", `#${KEY}=${i}`);
  followAddress();
  title.focus();
}

/** Shows for each condition of the current step whether it holds, and how many of the lesson do. */
function showConditions(): void {
  if (isList || current === null) return;
  const before = current.steps.slice(0, step).flat().filter(isCheck).length;
  [...body.querySelectorAll(".conditions")].forEach((block, i) => {
    block.replaceChildren(...(judged?.checks[before + i] ?? []).map(it => {
      const item = create("li", it.holds ? "holds" : "");
      const found = it.start === null ? it.found : `${it.found}, at the start ${it.start}`;
      item.append(create("span", "condition-mark", it.holds ? "✓" : "○"),
        create("span", "", it.words || it.condition));
      if (!/^(true|false)$/.test(it.found)) item.append(create("span", "found", `now ${found}`));
      item.firstElementChild?.setAttribute("aria-label", it.holds ? "holds:" : "does not hold:");
      item.firstElementChild?.setAttribute("role", "img");
      item.title = it.condition;
      return item;
    }));
  });
  const all = judged?.checks.flat() ?? [];
  const held = all.filter(it => it.holds).length;
  const isAsked = body.querySelector(".conditions") !== null;
  setText(state, judged?.holds ? "Solved. ✓"
    : judged !== null && isAsked ? `${held} of ${all.length} hold` : "");
}

/** Returns the number of the lesson after the current one. The host's lesson has none. */
function following(): number | null {
  const number = lessons.indexOf(current);
  return number > 0 && number + 1 < lessons.length ? number + 1 : null;
}

back.addEventListener("click", () => turn(-1));
on.addEventListener("click", () => turn(1));
function turn(by: number): void {
  const next = following();
  if (step + by === current?.steps.length) return next === null ? undefined : choose(next);
  step += by;
  show();
  // A button that is disabled loses the focus.
  if (document.activeElement === document.body) title.focus();
}

byId("lesson-again").addEventListener("click", () => {
  if (current !== null) files.start(`${current.name}.scn`, current.start);
});
byId("lesson-list").addEventListener("click", () => {
  isList = true;
  show();
  title.focus();
});
byId("lesson-close").addEventListener("click", () => {
  close();
  byId("lessons").focus();
  if (inAddress(KEY) !== null) history.pushState(null, "", location.pathname + location.search);
});
byId("lessons").addEventListener("click", () => {
  if (!panel.hidden) return byId("lesson-close").click();
  show();
  title.focus();
});
