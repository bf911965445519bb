//! Pinhole reads a small declarative scene language and renders what it describes through a virtual
//! pinhole camera.
//!
//! The modules below stand in the order in which a scene becomes a picture; each imports those
//! before it, none those after it. This is the whole way:
//!
//! ```
//! use pinhole::{area::Area, film, render, sampling::Sampling, scene, source::*, tracer::World};
//!
//! let text = "camera { eye (0, 2, 5) lookat (0, 1, 0) } sphere { center (0, 1, 0) } checkerboard {}";
//! let sources = Sources::new(Source::from_text("a.scn", text)).with_sets(["image.width=64", "image.height=36"]);
//! let scene = scene::read(&sources).scene.expect("a scene without mistakes");
//! let world = World::new(&scene);
//! let sampling = Sampling::new(&scene.sampler, scene.image.width, scene.image.height);
//! let film = render::render(&world, &sampling, Area::whole(64, 36), &render::Control::default())?;
//! film::write_exr(&film, Area::whole(64, 36), Area::whole(64, 36), &mut std::io::Cursor::new(Vec::new()))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - A text and its places: [`source`]. What is wrong with it: [`diagnostic`], a list that the
//!   terminal, JSON and editors show alike. [`explain`] has a page for each kind of mistake.
//! - The facts of the language, its blocks, fields and names: [`schema`]. [`syntax`] makes a tree
//!   of the text, and cannot fail. [`scene`] makes of the tree what it means: plain data,
//!   everything resolved.
//! - [`textbook`] has the formulas that everybody writes, in `f64`. [`tracer`] knows what is seen
//!   at a point of the picture, without a wrong decision; its documentation says how.
//!   [`projection`] leads to points of the picture and back in rounded numbers. [`sampling`] says
//!   where a pixel's points lie. [`render`] counts what they see, and [`refine`] shows coarse
//!   pictures until it has.
//! - Who has no more use for a result sets a flag, and all of these are given up soon after it:
//!   [`cancel`].
//! - [`film`] makes bytes of the means and files of the bytes; [`files`] opens files, and sees to
//!   it that they are written whole or not at all.
//! - [`mod@format`] lays a text out in the one canonical way.
//! - [`inspect`] and [`probe`] answer questions about a scene, [`grading`] one about a picture of
//!   it: what went wrong; and [`report`] about Pinhole itself: how right and how fast it is.
//! - [`editor`] answers one who is writing a scene: what could stand here, what a word means, where
//!   a name is used. `lsp` says that to editors in the Language Server Protocol, `preview` tells
//!   when a file has changed, and `studio` serves a page that edits one.
//! - The command line, `cli`, reads, calls all of these and prints; the binary does nothing else.

pub mod area;
pub mod cancel;
pub mod color;
pub mod diagnostic;
pub mod explain;
pub mod files;
pub mod math;
pub mod numbers;
pub mod source;
pub mod suggest;
#[cfg_attr(target_family = "wasm", path = "one_thread.rs")]
pub mod threads;

pub mod schema;
pub mod syntax;

pub mod scene;
pub mod textbook;
pub mod tracer;

pub mod projection;

pub mod sampling;

pub mod exact;

pub mod refine;
pub mod render;

pub mod film;

pub mod format;
pub mod grading;
pub mod inspect;
pub mod probe;
// Its trials are shared by threads, which a browser has not.
#[cfg(not(target_family = "wasm"))]
pub mod report;
pub mod seen;

pub mod editor;
#[cfg(feature = "lsp")]
pub mod lsp;
#[cfg(feature = "preview")]
pub mod preview;
#[cfg(feature = "lsp")]
pub mod studio;

#[cfg(feature = "cli")]
pub mod cli;
