// The results of the methods `pinhole/…` and `studio/…`; docs/protocol.md describes them.

import type { Range, TextEdit } from "vscode-languageserver-protocol";

/** A point of the picture, in its pixels, from the top left corner. */
export type Point = readonly [number, number];

/** A line through points in order. */
export type Polyline = readonly Point[];

export interface Frame { version: number; width: number; size: [number, number]; png: string }

export interface SceneObject {
  index: number; kind: string; name: string | null; range: Range; selection: Range;
  label: string; // the name, or a description that is unique among unnamed objects
  indices?: number[]; // indices of an object of a repeated block
}

export interface Handle { handle: string; at: Point | null; label: string }
export interface DrawnObject extends SceneObject { outline: Polyline[]; handles: Handle[] }
/** An object with a description of its place in the picture, null for some checkerboards. */
export interface ListedObject extends SceneObject { place: string | null }

export interface Overlays {
  axis: Point;
  horizon: Polyline | null;
  vanishing: { axis: "x" | "y" | "z"; point: Point | null; lines: Polyline[] }[];
  near: Polyline[]; far: Polyline[];
  objects: DrawnObject[];
}

export interface Pick {
  object: SceneObject | null;
  /** The pixel and a description of what it shows; both null outside the picture. */
  pixel: Point | null; text: string | null;
}

/** Constraint of a drag: one axis of the world, or (`floor`) a plane of constant y. */
export type Along = "x" | "y" | "z" | "floor";

export interface Dragged {
  edits: TextEdit[];
  values: string[];
  /** Names of other fields that change as a consequence, such as `camera.lookat`. */
  also?: string[];
}

/** Range, step and decimals of a number; `ends` are the ends of its slider. */
export interface Limits {
  least: number | null; most: number | null; step: number; decimals: number; ends: [number, number];
}
/** A `let` definition. `limits` is null unless it is a number or an angle; `note` says why the
 *  comment behind it is not taken as a range. */
export interface Slider { name: string; range: Range; limits: Limits | null; note: string | null }

/** The edits that add a block, its object's name, and where to put the cursor in the block. */
export interface Added { edits: TextEdit[]; name: string | null; cursor: number }
export interface Samples { points: Point[]; colors: string[]; color: string }

/** The host's file; `text` is null if it does not exist or cannot be read. */
export interface HostedFile {
  name: string;
  text: string | null;
  /** Reason why there is no text, if something other than a file has the path. */
  reason?: string | null;
  saved: boolean;
  /** Unsaved drafts, the newest first; sent only to a new page. */
  drafts?: Draft[];
}

/** Unsaved text, with the key of its page and the text it is based on; `time` is in seconds. */
export interface Draft { id: string; name: string; text: string; base: string | null; time: number }

/** Whether the file was saved; if not, `text` is the file's current content. */
export type Saved = { ok: true } | { ok: false; text: string | null };

/** Error response from the server. */
export class Refusal extends Error {
  constructor(readonly code: number, message: string) { super(message); }
}

/** Returns whether the server cancelled the request in favour of a newer one. */
export function isSuperseded(error: unknown): boolean {
  return error instanceof Refusal && (error.code === -32800 || error.code === -32801);
}
