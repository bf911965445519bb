// The answers of `pinhole/…` and `studio/…`, as docs/protocol.md describes them.

import type { Range, TextEdit } from "vscode-languageserver-protocol";

/** A point of the picture, in pixels of the scene, from the top left corner. */
export type Point = readonly [number, number];

/** A line through points. */
export type Polyline = readonly Point[];

export interface Frame { version: number; width: number; size: [number, number]; png: string }

export interface SceneObject {
  index: number; kind: string; name: string | null; range: Range; selection: Range;
  label: string; // the name, or a description that is unique among unnamed objects
  indices?: number[]; // indices of an object of a repeated block
}

export interface Handle { handle: string; at: Point | null; label: string }
export interface DrawnObject extends SceneObject { outline: Polyline[]; handles: Handle[] }
/** An object and its place in the picture, in words. */
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
  /** The pixel and what it shows, in words; null outside the picture. */
  pixel: Point | null; text: string | null;
}

/** Constraint of a drag: an axis of the world, or the plane of equal y. */
export type Along = "x" | "y" | "z" | "floor";

export interface Dragged {
  edits: TextEdit[];
  values: string[];
  /** Other fields that change, such as `camera.lookat`. */
  also?: string[];
}

/** Limits of a number, and the `ends` of its slider. */
export interface Limits {
  least: number | null; most: number | null; step: number; decimals: number; ends: [number, number];
}
/** A `let`, and the limits of its slider if it is a number or an angle; `note` says why the comment
 *  behind it is not a range. */
export interface Slider { name: string; range: Range; limits: Limits | null; note: string | null }

/** A new block: the edits that write it, and the offset of its start. */
export interface Added { edits: TextEdit[]; name: string | null; cursor: number }
export interface Samples { points: Point[]; colors: string[]; color: string }

/** The file that a served page edits; its text is null if there is none. */
export interface HostedFile {
  name: string;
  text: string | null;
  /** Reason why the path has no text, if something else is there. */
  reason?: string | null;
  saved: boolean;
  /** Unsaved drafts for a new page, the newest first. */
  drafts?: Draft[];
}

/** Unsaved text with its page's key and its base; the time is in seconds. */
export interface Draft { id: string; name: string; text: string; base: string | null; time: number }

/** Whether the file was saved; if not, its current content. */
export type Saved = { ok: true } | { ok: false; text: string | null };

/** Error response of the server. */
export class Refusal extends Error {
  constructor(readonly code: number, message: string) { super(message); }
}

/** Returns whether an error says that a newer request has superseded this one. */
export function isSuperseded(error: unknown): boolean {
  return error instanceof Refusal && (error.code === -32800 || error.code === -32801);
}
