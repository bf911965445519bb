// Lessons, below the text: a list of them, or the steps of the open one. After each change of the
// scene, the engine judges whether the lesson's conditions hold. The page's address names the open
// lesson, so a reload opens it again.

import { marked, type Token, type Tokens } from "marked";
import { inAddress } from "./address";
import { byId, create, createButton, newestOf, remember, remembered } from "./dom";
import { editor } from "./editor";
import { files } from "./files";
import { frames } from "./frames";
import { overlays } from "./overlays";
import { Refusal, type Condition, type Judged, type LessonText } from "./protocol";
import { sanitized } from "./sanitize";
import { say, unsay } from "./status";
import { tools } from "./tools";
import { setText } from "./visible";

/** Delay after a change, in ms, before the conditions are judged. With a shorter one, each step of
 * a drag would be judged, which would delay its pictures. */
const REST = 150;
const KEY = "lesson";

/** A lesson, with its title and the Markdown of its steps. */
interface Lesson extends LessonText { title: string; steps: Token[][] }

/** Item 0 is the lesson of the host, or null if the host has none. The others are the page's
 * lessons. */
const lessons: (Lesson | null)[] = [null, ...LESSONS.map(read)];

const section = byId("lesson");
const title = byId("lesson-title");
const body = byId("lesson-body");
const state = byId("lesson-state");
const [back, on] = [byId<HTMLButtonElement>("lesson-back"), byId<HTMLButtonElement>("lesson-next")];

let current: Lesson | null = null;
let step = 0;
/** Whether the host's lesson is about the user's own scene instead of the lesson's scene. */
let usesOwnScene = false;
/** Whether the section shows the list of all lessons. */
let isList = true;
/** The engine's last answer about the current lesson; null if there is none yet. */
let judged: Judged | null = null;
const solved = new Set(remembered("solved")?.split("\n"));
/** Text that each lesson's scene had when the user last left the lesson. */
const texts = new Map<Lesson, string>();

/** Splits a lesson's Markdown into its title and its steps, which begin with headings `##`. */
function read(lesson: LessonText): Lesson {
  const steps: Token[][] = [[]];
  let title = lesson.name;
  for (const token of marked.lexer(lesson.text)) {
    const depth = token.type === "heading" ? (token as Tokens.Heading).depth : 0;
    if (depth === 1) title = plain((token as Tokens.Heading).tokens);
    else if (depth === 2) steps.push([{ ...token, depth: 3 } as Token]);
    else if (token.type !== "space") steps.at(-1)?.push(token);
  }
  return { ...lesson, title, steps: steps.filter(it => it.length > 0) };
}

/** Returns the text of inline Markdown without its formatting. */
function plain(tokens: Token[]): string {
  const html = sanitized(marked.Parser.parseInline(tokens));
  return Object.assign(create("div"), { innerHTML: html }).textContent;
}

/** Opens the lesson that the page's address names. If it names none, opens the host's lesson `own`.
 * The scene of the host's lesson replaces the page's scene only if the page's scene is new
 * (`isNew`). Otherwise, the lesson is about the page's scene. */
export function startLessons(own: LessonText | null | undefined, isNew: boolean): void {
  if (own != null) lessons[0] = read(own);
  usesOwnScene = !isNew;
  if (inAddress(KEY) !== null) followAddress();
  else if (lessons[0]) open(lessons[0]);
}

/** Last message that there is no lesson of the number in the page's address. */
let absent = "";

/** Opens the lesson that the page's address names. If it names none, closes the open lesson. */
export function followAddress(): void {
  const named = inAddress(KEY);
  unsay(absent);
  if (named === null) return close();
  const lesson = lessons[Number(named)];
  if (lesson) open(lesson);
  else say(absent = `There is no lesson ${named}.`, "warning");
}

/** Opens a lesson. Its scene replaces the page's scene, unless the lesson is about the user's own
 * scene, or the page's address contains a scene. */
function open(lesson: Lesson): void {
  if (lesson !== current) {
    keepText();
    [current, step, judged] = [lesson, 0, null];
    tools.reset();
    overlays.restoreLayers();
    if ((usesOwnScene && lesson === lessons[0]) || inAddress("scene") !== null) files.leaveLesson();
    else {
      files.startLesson(`${lesson.name}.scn`, lesson.start, texts.get(lesson) ?? lesson.start);
      overlays.hideLayers();
    }
  }
  isList = false;
  show();
  lessonChanged();
}

function keepText(): void {
  if (current !== null && files.isLesson) texts.set(current, editor.text);
}

/** Closes the lesson, and shows the user's own scene again. */
function close(): void {
  keepText();
  files.leaveLesson();
  overlays.restoreLayers();
  current = null;
  isList = true;
  section.hidden = true;
  byId("lessons").setAttribute("aria-expanded", "false");
}

/** Removes the lesson from the page's address. */
function leaveAddress(): void {
  if (inAddress(KEY) !== null) history.pushState(null, "", location.pathname + location.search);
}

files.closeLesson = () => {
  if (!files.isLesson) return;
  close();
  // A link that is being opened stays in the address.
  if (inAddress("scene") === null) leaveAddress();
};

let timer: ReturnType<typeof setTimeout>;

/** Has the lesson's conditions judged after a pause in changes of the scene or the lesson. During a
 * drag, they are not judged. */
export function lessonChanged(): void {
  clearTimeout(timer);
  if (current !== null) timer = setTimeout(judge, REST, current);
}

const judge = newestOf(async (lesson: Lesson) => {
  if (lesson !== current || editor.uri === "" || frames.dragging !== null) return;
  const { doc } = editor.view.state;
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
});

/** Shows the current step, or the list of all lessons. */
function show(): void {
  section.hidden = false;
  byId("lessons").setAttribute("aria-expanded", "true");
  section.classList.toggle("is-list", isList);
  if (isList || current === null) {
    setText(title, "Lessons");
    body.replaceChildren(list());
    return setText(state, "");
  }
  const { steps } = current;
  const number = lessons.indexOf(current);
  setText(title, number === 0 ? current.title : `${number}. ${current.title}`);
  setText(byId("lesson-step"), `step ${step + 1} of ${steps.length}`);
  body.replaceChildren(...elements(steps[step] ?? []));
  body.scrollTop = 0;
  back.disabled = step === 0;
  const isLast = step === steps.length - 1;
  setText(on, isLast ? "Next lesson ▸" : "Next ▸");
  on.disabled = isLast && nextNumber() === null;
  showConditions();
}

/** Returns an element for each token of a step. The element of a block `check` is empty until
 * `fill` adds the conditions. */
const elements = (tokens: Token[]): HTMLElement[] => tokens.map(token => isCheck(token)
  ? create("ul", "conditions")
  : Object.assign(create("div"), { innerHTML: sanitized(marked.parser([token])) }));

/** Returns the open lesson with all of its steps, for paper. Returns nothing if no lesson is open.
 */
export function lessonOnPaper(): HTMLElement[] {
  if (section.hidden || isList || current === null) return [];
  const tokens = current.steps.flat();
  const all = elements(tokens);
  fill(tokens, all);
  return [create("h2", "", title.textContent), ...all];
}

/** Returns whether the token is a block `check`, in which the engine reads conditions. Like the
 * engine (src/lesson/parser.rs), accepts a fence only at the start of a line. */
const isCheck = ({ type, raw }: Token): boolean =>
  type === "code" && /^(```+|~~~+)[ \t]*check[ \t]*(\n|$)/.test(raw);

/** Returns the conditions in a block `check`, each in the form that `normalized` returns. */
const conditionsIn = (token: Token): string[] => (token as Tokens.Code).text.split("\n")
  .map(line => line.trim()).filter(line => line !== "" && !line.startsWith("//")).map(normalized);
/** Removes white space and `//` from a line with a condition and its description in words. Then
 * the page's and the engine's forms of the line are equal. */
const normalized = (line: string) => line.replace(/\s|\/\//g, "");

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

/** Opens a lesson by changing the page's address. The browser's Back button then leads to the
 * page's previous address. */
function choose(i: number): void {
  history.pushState(null, "", `#${KEY}=${i}`);
  followAddress();
  title.focus();
}

/** Shows for each condition of the current step whether it holds, and how many conditions hold. If
 * all conditions of the lesson hold, says that the lesson is solved. */
function showConditions(): void {
  if (isList || current === null) return;
  const all = fill(current.steps[step] ?? [], [...body.children]);
  setText(state, judged?.holds ? "Solved. ✓"
    : all.length > 0 ? `${all.filter(it => it.holds).length} of ${all.length} hold` : "");
}

/** Fills the element of each block `check` in `tokens` with its conditions and whether they hold.
 * `elements` has one element per token. Returns all conditions. */
function fill(tokens: Token[], elements: Element[]): Condition[] {
  return tokens.flatMap((token, i) => {
    if (!isCheck(token)) return [];
    // The engine may read a block that the page does not show, such as one in an HTML comment.
    // Therefore, a block is found by its conditions, not by its number.
    const wanted = String(conditionsIn(token));
    const found = judged?.checks.find(block =>
      String(block.map(it => normalized(it.condition + it.words))) === wanted) ?? [];
    elements[i]?.replaceChildren(...found.map(condition));
    return found;
  });
}

/** Returns a row with a condition, whether it holds, and the value that was found. */
function condition(it: Condition): HTMLElement {
  const item = create("li", it.holds ? "holds" : "");
  const found = it.start === null ? it.found : `${it.found}, at the start ${it.start}`;
  item.append(create("span", "condition-mark", it.holds ? "✓" : "○"),
    create("span", "", it.words || it.condition));
  if (!/^(true|false)$/.test(it.found)) item.append(create("span", "found", `now ${found}`));
  item.firstElementChild?.setAttribute("aria-label", it.holds ? "holds:" : "does not hold:");
  item.firstElementChild?.setAttribute("role", "img");
  item.title = it.condition;
  return item;
}

/** Returns the number of the lesson after the current one. Returns null after the last lesson, and
 * for the host's lesson. */
function nextNumber(): number | null {
  const number = lessons.indexOf(current);
  return number > 0 && number + 1 < lessons.length ? number + 1 : null;
}

back.addEventListener("click", () => turn(-1));
on.addEventListener("click", () => turn(1));
function turn(by: number): void {
  const next = nextNumber();
  if (step + by === current?.steps.length) return next === null ? undefined : choose(next);
  step += by;
  show();
  // If the button that was pressed is now disabled, it has lost the focus, so the title gets it.
  if (document.activeElement === document.body) title.focus();
}

byId("lesson-again").addEventListener("click", () => {
  if (current === null) return;
  if (files.isLesson) editor.replace(current.start);
  else files.startLesson(`${current.name}.scn`, current.start, current.start);
});
byId("lesson-list").addEventListener("click", () => {
  isList = true;
  show();
  title.focus();
});
byId("lesson-close").addEventListener("click", () => {
  close();
  byId("lessons").focus();
  leaveAddress();
});
byId("lessons").addEventListener("click", () => {
  if (!section.hidden) return byId("lesson-close").click();
  show();
  title.focus();
});
