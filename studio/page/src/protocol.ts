// Results of the methods `pinhole/…` and `studio/…`, which docs/protocol.md describes.

import type { Range, TextEdit } from "vscode-languageserver-protocol";

/** A point of the picture, in pixels from its top left corner. */
export type Point = readonly [number, number];

/** A line through several points, in their order. */
export type Polyline = readonly Point[];

export interface Frame { version: number; width: number; size: [number, number]; png: string }

export interface SceneObject {
  index: number; kind: string; name: string | null; range: Range; selection: Range;
  label: string; // the name, or a description that is unique among unnamed objects
  indices?: number[]; // of an object of a repeated block: the values of the block's indices
}

export interface Handle { handle: string; at: Point | null; label: string }
export interface DrawnObject extends SceneObject { outline: Polyline[]; handles: Handle[] }
/** An object, with words for its place in the picture. `place` is null if the server cannot tell
 * where a checkerboard is. */
export interface ListedObject extends SceneObject { place: string | null }

export interface Overlays {
  axis: Point;
  horizon: Polyline | null;
  vanishing: { axis: "x" | "y" | "z"; point: Point | null; lines: Polyline[] }[];
  near: Polyline[]; far: Polyline[];
  objects: DrawnObject[];
  /** The second camera of a view from outside. Absent if no such view was requested. */
  view?: View;
  camera?: {
    lines: Record<CameraLine, Polyline[]>;
    handles: Handle[];
    met: Point[];
  };
}

export type Vector = readonly [number, number, number];

/** A second camera, which shows the scene from outside. */
export interface View { eye: Vector; lookat: Vector; up: Vector; fov: number; size: Point }

/** Lines of the scene's camera in a view from outside. */
export type CameraLine =
  "frustum" | "rays" | "axis" | "window" | "near" | "far" | "up" | "ray";

export interface Pick {
  object: SceneObject | null;
  /** The pixel, and a description of what it shows. Both are null outside of the picture. */
  pixel: Point | null; text: string | null;
}

/** Axis along which an object is dragged, or (`floor`) the horizontal plane. */
export type Along = "x" | "y" | "z" | "floor";

export interface Dragged {
  edits: TextEdit[];
  values: string[];
  /** Names of other fields, such as `camera.lookat`, whose values the edits change too. A drag
   * changes numbers in the text, and a definition with `let` may be used by several fields. */
  also?: string[];
}

/** Smallest and largest value, step and number of decimals of a number in the text. `ends` are the
 * two ends of its slider. */
export interface Limits {
  least: number | null; most: number | null; step: number; decimals: number; ends: [number, number];
}
/** A definition with `let`. `limits` is null if its value is neither a number nor an angle. `note`
 * is a message for the user if the comment after the definition is no valid range, or differs from
 * the slider's range. */
export interface Slider { name: string; range: Range; limits: Limits | null; note: string | null }

/** Edits that add a block, the name of its object, and an offset in the block for the cursor. */
export interface Added { edits: TextEdit[]; name: string | null; cursor: number }
export interface Samples { points: Point[]; colors: string[]; color: string; mean: number[] }

export interface Glass {
  png: string;
  seen: { color: string; share: number; label: string | null; object: number | null }[];
  mean: number[];
  color: string;
  bound: number;
  method: string;
  counts: number[];
  errors: { method: string; typical: number[]; own: number[] }[];
}

/** A lesson: its name, its Markdown, and the text of its scene. */
export interface LessonText { name: string; text: string; start: string }
/** Result of judging a lesson: whether the scene solves it, and the conditions of each block
 * `check`. */
export interface Judged {
  holds: boolean;
  checks: Condition[][];
}

/** A condition of a lesson, and whether it holds for the scene. `found` is the value in the scene.
 * `start` is the value in the lesson's own scene, or null unless the condition compares the two. */
export interface Condition {
  condition: string;
  words: string;
  found: string;
  start: string | null;
  holds: boolean;
}

/** The host's file. `text` is null if the file does not exist or cannot be read. */
export interface HostedFile {
  name: string;
  text: string | null;
  /** Reason why there is no text, for example because the path is a folder. */
  reason?: string | null;
  saved: boolean;
  /** Unsaved drafts, the newest first. They are sent only to a page that has just connected. */
  drafts?: Draft[];
  /** The lesson with which the host was started. */
  lesson?: LessonText | null;
}

/** Unsaved text of the page with the key `id`. `base` is the content of the file when editing
 * began; null if there was no file. `time` is when the draft was made, in seconds since 1970. */
export interface Draft { id: string; name: string; text: string; base: string | null; time: number }

/** Whether the file was saved. If not, `text` is the file's current content, or null if the file
 * was removed. */
export type Saved = { ok: true } | { ok: false; text: string | null };

/** Error with which the server answers a request. */
export class Refusal extends Error {
  constructor(readonly code: number, message: string) { super(message); }
}

/** Returns whether the server has dropped the request, because a newer one replaced it or the text
 * has changed. */
export function isSuperseded(error: unknown): boolean {
  return error instanceof Refusal && (error.code === -32800 || error.code === -32801);
}
