//! Pinhole reads a small declarative scene language and renders scenes through a virtual pinhole
//! camera. Which object a sample shows is decided exactly, without rounding errors.
//!
//! A text becomes a [`Scene`], and a scene a [`Picture`] in memory:
//!
//! ```
//! use pinhole::Scene;
//!
//! let text = "camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere { center (0, 1, 0) }";
//! let scene = Scene::parse(text)?.with_sets(["image.width=160", "image.height=90"])?;
//! let picture = scene.render()?;
//! assert_eq!(picture.to_rgb8().len(), 160 * 90 * 3);
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("ball.png");
//! picture.save(path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`Scene::parse`] returns the scene, or all [`Mistakes`] of the text. Each of them is a
//!   [`Diagnostic`] with its places and fixes, and [`Mistakes::fixed`] applies them.
//!   [`Scene::diagnostics`] returns the warnings.
//! - [`Scene::render`] samples as the scene says; [`Scene::render_exact`] computes each pixel's
//!   mean with a bound on its error. A [`Picture`] returns its pixels as bytes or in linear light,
//!   and is saved to a file.
//! - [`Picture::rmse`] says how much two pictures differ, and [`Scene::grade`] what is wrong with
//!   the picture of another program.
//! - [`Scene::data`] returns what the text means, as plain data. [`Scene::from_data`] checks a
//!   changed copy of the data, and makes a scene from it, whose text is generated.
//!
//! # Features
//!
//! Without any feature, the library reads a text, renders to memory, computes exact pictures, and
//! returns problems and answers as data. By default, all features are enabled. To compile only what
//! you use, depend on the library with `default-features = false` and list its features:
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `png` | PNG files, which carry their scene: `Picture::save`, `Scene::open`, `film` |
//! | `exr` | OpenEXR files in linear light: `Picture::save`, `film::write_exr` |
//! | `read` | pictures of any program: `Picture::open`, `Scene::grade`; includes `png` and `exr` |
//! | `fancy` | [`Mistakes`] displayed with excerpts, as in a terminal: `diagnostic::Report` |
//! | `json` | problems as lines of JSON: `diagnostic::json_lines`; `lesson` |
//! | `report` | reports on accuracy and on speed: `report` |
//! | `lsp` | the answers that editors ask for, and the language server: `editor`, `lsp`, `refine` |
//! | `preview` | notification when a scene's file is changed, and `refine` |
//! | `studio` | the host of the page on which scenes are edited |
//! | `cli` | the command line, `editor`, `figure`; includes `fancy`, `preview`, `read`, `report` |
//! | `files`, `pages` | parts of other features, not useful alone |
//!
//! # Stages
//!
//! The modules below serve programs that render only a part of a picture, show the progress of a
//! render or cancel it, ask questions about a scene, or work on a text while it is typed. They are
//! listed in groups, roughly in the order in which a scene becomes a picture. A group imports only
//! earlier groups, and modules of one group never import each other in a circle; a test checks
//! this. The whole pipeline:
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
//! let left_half = Area::whole(32, 36);
//! let film = render::render(&world, &sampling, left_half, &render::Control::default())?;
//! let mut file = std::io::Cursor::new(Vec::new());
//! film::write_exr(&film, left_half, Area::whole(64, 36), None, &mut file)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`source`] contains texts and positions in them. [`diagnostic`] contains the problems of a
//!   text, which terminals, JSON and editors show alike. [`explain`] contains a page for each kind
//!   of problem.
//! - [`schema`] defines the blocks, fields and names of the language. [`syntax`] parses a text into
//!   a tree, and never fails. [`scene`] converts the tree to plain data, in which all names are
//!   resolved and all values are computed.
//! - [`tracer`] finds exactly what is seen at a point of the picture; its documentation says how.
//!   [`sampling`] places the sample points of pixels, [`render`] averages what is seen at them, or
//!   computes means without samples, and [`refine`] shows coarse pictures until the final one is
//!   done.
//! - [`cancel`]: a flag ends any of these computations early.
//! - [`film`] converts means to bytes, and encodes and decodes files.
//! - [`mod@format`] writes a text in the canonical layout.
//! - [`inspect`], [`seen`] and [`probe`] answer questions about a scene, `lesson` judges whether a
//!   scene solves a lesson, [`grading`] finds the mistakes in a picture of a scene, and `report`
//!   measures how accurate and how fast Pinhole itself is.
//! - [`editor`] answers questions while a scene is written: completions, explanations of words,
//!   uses of names. `lsp` serves these answers to editors by the Language Server Protocol.
//! - [`figure`] draws figures of a scene for teaching material, as SVG.
//!
//! The other modules are internal to Pinhole. `library` contains the types with which this page
//! begins. `math`, `numbers`, `suggest`, `threads` and `files` may be used by every stage.
//! `reference` contains what the tracer is tested against: textbook formulas in `f64`, formulas
//! with arbitrary precision, and hard scenes. `projection` maps points of the scene to the picture
//! and back, in rounded numbers, and `exact` integrates a pixel. `preview` reports changes of a
//! file, and `studio` serves a page to edit a scene. `cli`, the command line, reads input, calls
//! the other modules and prints the results.

// On docs.rs, the documentation of an item says which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod area;
pub mod cancel;
pub mod color;
pub mod diagnostic;
pub mod explain;
#[doc(hidden)]
pub mod files;
mod lock;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod numbers;
pub mod source;
#[doc(hidden)]
pub mod suggest;
#[cfg_attr(target_family = "wasm", path = "one_thread.rs")]
#[doc(hidden)]
pub mod threads;

pub mod schema;
pub mod syntax;

pub mod scene;

#[doc(hidden)]
pub mod reference;
pub mod tracer;

#[doc(hidden)]
pub mod projection;

pub mod sampling;

pub mod film;

#[doc(hidden)]
pub mod exact;

#[cfg(any(feature = "lsp", feature = "preview"))]
pub mod refine;
pub mod render;

pub mod format;
#[cfg(feature = "read")]
pub mod grading;
pub mod inspect;
#[cfg(feature = "json")]
pub mod lesson;
pub mod probe;
#[cfg(feature = "report")]
pub mod report;
pub mod seen;

mod library;

#[cfg(any(feature = "cli", feature = "lsp"))]
pub mod editor;
#[cfg(feature = "cli")]
pub mod figure;
#[cfg(feature = "lsp")]
#[doc(hidden)]
pub mod lsp;
// In a browser, there are no files to watch, so WebAssembly omits this module.
#[cfg(all(feature = "preview", not(target_family = "wasm")))]
#[doc(hidden)]
pub mod preview;
#[cfg(feature = "studio")]
#[doc(hidden)]
pub mod studio;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;

#[cfg(feature = "read")]
#[doc(inline)]
pub use crate::grading::Verdict;
#[doc(inline)]
pub use crate::{
    color::Color,
    diagnostic::{Applicability, Diagnostic, Mistakes},
    library::{Error, Exact, Picture, Scene},
    math::Angle,
    scene::{Method, Scene as SceneData},
};
pub use glam;
