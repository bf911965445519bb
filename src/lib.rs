//! Pinhole reads a small declarative scene language and renders what it describes through a virtual
//! pinhole camera.
//!
//! The modules below stand in groups, roughly in the order in which a scene becomes a picture. A
//! group imports only groups before it, and modules of one group import each other one way; a test
//! holds this. The whole pipeline:
//!
//! ```
//! use pinhole::{area::Area, film, render, sampling::Sampling, scene, source::*, tracer::World};
//!
//! let text = "camera { eye (0, 2, 5) lookat (0, 1, 0) } sphere { center (0, 1, 0) }";
//! let size = ["image.width=64", "image.height=36"];
//! let sources = Sources::new(Source::from_text("a.scn", text)).with_sets(size);
//! let scene = scene::read(&sources).scene.expect("a scene without mistakes");
//! let world = World::new(&scene);
//! let sampling = Sampling::new(&scene.sampler, scene.image.width, scene.image.height);
//! let whole = Area::whole(64, 36);
//! let film = render::render(&world, &sampling, whole, &render::Control::default())?;
//! film::write_exr(&film, whole, whole, &mut std::io::Cursor::new(Vec::new()))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`source`] has texts and positions in them. [`diagnostic`] has the problems of a text, a list
//!   that the terminal, JSON and editors show alike, and [`explain`] a page for each kind of
//!   problem.
//! - [`schema`] has the facts of the language: blocks, fields and names. [`syntax`] parses a text
//!   into a tree, and cannot fail. [`scene`] lowers the tree to plain data with everything
//!   resolved.
//! - [`reference`](mod@reference) has what the tracer is compared with: textbook formulas in `f64`,
//!   an oracle of arbitrary precision, and hard scenes. [`tracer`] finds what is seen at a point of
//!   the picture, without a wrong decision; its documentation says how. [`projection`] maps points
//!   of the scene to the picture and back, in rounded numbers. [`sampling`] places the sample
//!   points of pixels, [`render`] averages what they see, [`exact`] computes a pixel's mean without
//!   samples, and [`refine`] shows coarse pictures until the final one is done.
//! - [`cancel`]: a flag ends any of these computations early.
//! - [`film`] converts means to bytes, and encodes files; [`files`] opens files, and writes them
//!   completely or not at all.
//! - [`mod@format`] lays a text out canonically.
//! - [`inspect`] and [`probe`] answer questions about a scene, [`grading`] finds the mistakes in a
//!   picture of a scene, and [`report`] measures how accurate and how fast Pinhole itself is.
//! - [`editor`] answers questions while a scene is written: completions, explanations of words,
//!   uses of names. `lsp` serves these answers to editors by the Language Server Protocol,
//!   `preview` notifies of a file's changes, and `studio` serves a page to edit a scene.
//! - [`figure`] draws what the program knows of a scene for a page of a course, as SVG.
//! - `cli`, the command line, reads input, calls all of these and prints; the binary does nothing
//!   else.

pub mod area;
pub mod cancel;
pub mod color;
pub mod diagnostic;
pub mod explain;
pub mod files;
mod lock;
pub mod math;
pub mod numbers;
pub mod source;
pub mod suggest;
#[cfg_attr(target_family = "wasm", path = "one_thread.rs")]
pub mod threads;

pub mod schema;
pub mod syntax;

pub mod scene;

pub mod reference;
pub mod tracer;

pub mod projection;

pub mod sampling;

pub mod film;

pub mod exact;

pub mod refine;
pub mod render;

pub mod format;
pub mod grading;
pub mod inspect;
pub mod probe;
// Its trials run on threads, which a browser does not have.
#[cfg(not(target_family = "wasm"))]
pub mod report;
pub mod seen;

pub mod editor;
pub mod figure;
#[cfg(feature = "lsp")]
pub mod lsp;
#[cfg(feature = "preview")]
pub mod preview;
#[cfg(feature = "lsp")]
pub mod studio;

#[cfg(feature = "cli")]
pub mod cli;
