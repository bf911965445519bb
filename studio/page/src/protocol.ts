// The answers of `pinhole/…` and `studio/…`, as docs/protocol.md describes them.

import type { Range, TextEdit } from "vscode-languageserver-protocol";

/** A point of the picture, in pixels of the scene, from the top left corner. */
export type Point = readonly [number, number];

/** A line through points. */
export type Polyline = readonly Point[];

export interface Frame { version: number; width: number; size: [number, number]; png: string }

export interface SceneObject {
  index: number; kind: string; name: string | null; range: Range; selection: Range;
  label: string; // the name, or what tells it from others without one
  indices?: number[]; // which one of its block it is, where that stands for many
}

export interface Handle { handle: string; at: Point | null; label: string }
export interface DrawnObject extends SceneObject { outline: Polyline[]; handles: Handle[] }
/** An object and where in the picture it is seen, in words. */
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
  /** In which pixel it is, and what is seen, in words; null outside of the picture. */
  pixel: Point | null; text: string | null;
}

/** What a drag may be held to: an axis of the world, or the plane of equal y. */
export type Along = "x" | "y" | "z" | "floor";

export interface Dragged {
  edits: TextEdit[];
  values: string[];
  /** What else moves with it, as `camera.lookat`. */
  also?: string[];
}

/** How a number is turned, and between which `ends` on a slider. */
export interface Limits {
  least: number | null; most: number | null; step: number; decimals: number; ends: [number, number];
}
/** A `let`, and how a slider turns it, if it is a number or angle; `note` says why the comment
 *  behind it is no range. */
export interface Slider { name: string; range: Range; limits: Limits | null; note: string | null }

/** A block that is new: what writes it, and the offset at which it begins. */
export interface Added { edits: TextEdit[]; name: string | null; cursor: number }
export interface Samples { points: Point[]; colors: string[]; color: string }

/** The file that a served page edits: its text is null while there is none. */
export interface HostedFile {
  name: string;
  text: string | null;
  /** Why there is no text, where something else is there. */
  reason?: string | null;
  saved: boolean;
  /** What was written and not saved, when a page comes that is new: the newest first. */
  drafts?: Draft[];
}

/** A text that was not saved, under its page's key, and what it was made from; in seconds. */
export interface Draft { id: string; name: string; text: string; base: string | null; time: number }

/** Whether the file was saved; if not, what is in it now. */
export type Saved = { ok: true } | { ok: false; text: string | null };

/** An error that the server answered with. */
export class Refusal extends Error {
  constructor(readonly code: number, message: string) { super(message); }
}

/** Codes of answers that a newer question has made pointless. */
export function isSuperseded(error: unknown): boolean {
  return error instanceof Refusal && (error.code === -32800 || error.code === -32801);
}
