//! `watch`: renders a scene whenever its file is saved.

use std::{
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::{Duration, Instant},
};

use super::{
    CommandError, Status,
    args::WatchArgs,
    command_error,
    input::{self, SceneInput, shown},
    interrupt::Interrupt,
    output,
    picture::{PictureOutput, render_part},
    show::Screen,
};
use crate::{
    area::Area,
    film::SIGNATURE,
    preview, refine,
    render::{Control, RenderError, Rendered},
    scene::{self, Scene},
    tracer::World,
};

/// Renders the scene at the start and after every save, until Ctrl-C is pressed.
pub fn run(args: &WatchArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let start = Instant::now();
    let output = output(args)?;
    check_scene(&args.scene)?;
    output.check(&args.scene)?;
    let mut screen = if args.show {
        Screen::of_pictures()?
    } else {
        Screen::of_words()
    };
    let scene = shown(&args.scene);
    let latest = preview::watch(&args.scene, input::bytes)
        .map_err(|error| command_error(format!("cannot watch the folder of {scene}: {error}")))?;
    let ended = Arc::clone(&latest);
    interrupt.then(move || ended.end());
    screen.print(&format!("watching {scene}; Ctrl-C ends it\n"));
    let mut is_first = true;
    while let Some(content) = latest.take_while(REFIT, || screen.fit()) {
        if !is_first {
            screen.begin();
        }
        let written = content
            .bytes
            .map_err(|error| command_error(format!("cannot read {scene}: {error}")))
            .and_then(|bytes| render_and_write(args, bytes, &output, latest.stale(), &mut screen));
        match written {
            Ok(done) => {
                let (since, what) = if is_first {
                    (start, "after the start")
                } else {
                    (content.since, "after the save")
                };
                let time = time(done.duration_since(since));
                screen.print(&format!("wrote {output} {time} {what}\n"));
            }
            Err(CommandError::SceneErrors | CommandError::Interrupted) => {}
            // An error does not end watching, since the next save may remove its cause.
            Err(error) => screen.print(&output::worded_error(&error)),
        }
        is_first = false;
    }
    Ok(Status::Interrupted)
}

/// Interval between checks of the terminal's size while the scene does not change. If the size has
/// changed, the picture is drawn again. With a fifth of a second, this seems immediate, and the
/// checks take almost no time.
const REFIT: Duration = Duration::from_millis(200);

/// Returns the file to which the picture is written. Returns an error if the scene comes from
/// standard input, or the picture would go to standard output.
fn output(args: &WatchArgs) -> Result<PictureOutput, CommandError> {
    if input::is_standard(&args.scene) {
        return Err(command_error(
            "standard input cannot be watched: it is read once; give a file",
        ));
    }
    match PictureOutput::of(&args.scene, args.output.as_deref())? {
        PictureOutput::Standard => Err(command_error(
            "standard output holds one picture, and watch writes one after every save: give a file",
        )),
        file => Ok(file),
    }
}

/// Checks that the scene can be read and is not a picture. The check is made only at the start,
/// since an editor may remove the file for a moment while it saves.
pub fn check_scene(scene: &Path) -> Result<(), CommandError> {
    let bytes = input::bytes(scene).map_err(|error| input::unreadable(scene, &error))?;
    check_text(scene, &bytes)
}

fn check_text(scene: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    if bytes.starts_with(&SIGNATURE) {
        return Err(command_error(format!(
            "{} is a picture, and what is watched is a text that somebody edits: `render` takes pictures",
            shown(scene)
        )));
    }
    Ok(())
}

/// Renders the scene with the text `bytes` and writes its picture. Returns the time when it was
/// written. When `is_stale` is set, there is a newer text, so the work stops with the error
/// [`CommandError::Interrupted`].
fn render_and_write(
    args: &WatchArgs,
    bytes: Vec<u8>,
    output: &PictureOutput,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<Instant, CommandError> {
    check_text(&args.scene, &bytes)?;
    let input = SceneInput::of(&args.scene, bytes, &args.overrides);
    let reading = scene::read_unless(&input.sources, is_stale).map_err(RenderError::from)?;
    screen.print(&input.report(&reading));
    let scene = reading.scene.ok_or(CommandError::SceneErrors)?;
    let whole = Area::whole(scene.image.width, scene.image.height);
    let recipe = input.into_recipe(None, whole);
    let world = World::new_unless(&scene, is_stale).map_err(RenderError::from)?;
    let (written, shown) = match screen.side(whole) {
        None => {
            let written = output.render(&scene, &world, whole, &recipe, &args.scene, is_stale);
            (written, None)
        }
        Some(side) => {
            let rendered = with_sketch(&scene, &world, side, is_stale, screen)?;
            let written = output.write_rendered(&args.scene, &rendered, &recipe, is_stale);
            (written, Some(rendered.into_film()))
        }
    };
    if written.is_err() && is_stale.load(Ordering::SeqCst) {
        return Err(CommandError::Interrupted);
    }
    let done = Instant::now();
    // The picture is shown even if it could not be written.
    if let Some(film) = shown {
        screen.draw(film);
    }
    let note = written?;
    screen.print(&output.note_of_length(&recipe));
    screen.print(&note);
    Ok(done)
}

/// Time after which a render is so slow that coarse pictures are shown until it is finished. The
/// value is a guess at when a user gets impatient. With a shorter time, coarse pictures would flash
/// up during fast renders.
const PATIENCE: Duration = Duration::from_millis(200);

/// Renders the scene. If this takes longer than [`PATIENCE`], another thread shows coarse pictures
/// in the terminal, finer and finer ones. The first one consists of squares of `side` pixels.
fn with_sketch(
    scene: &Scene,
    world: &World,
    side: u32,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<Rendered, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        scope.spawn(move || {
            if wait.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let control = Control {
                threads: None,
                progress: &|_| {},
                cancel: is_stale,
            };
            // An error, usually that the render was cancelled, is ignored here, because the
            // render of the picture itself reports it.
            let _ = refine::coarse_to_fine(world, whole, side, &control, |sketch| {
                screen.draw(sketch.film);
            });
        });
        let picture = render_part(scene, world, whole, is_stale);
        drop(done);
        picture
    })
}

/// Formats a waiting time: in milliseconds below a second, otherwise in seconds.
fn time(waited: Duration) -> String {
    match waited.as_secs_f64() {
        seconds if seconds < 1.0 => format!("{:.0} ms", seconds * 1e3),
        seconds => format!("{seconds:.2} s"),
    }
}
