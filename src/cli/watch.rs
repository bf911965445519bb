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
    Status, Trouble,
    args::WatchArgs,
    input::{self, SceneInput, shown},
    interrupt::Interrupt,
    output,
    picture::{KeptPixels, PictureOutput, RenderedPicture, picture},
    show::Screen,
};
use crate::{
    area::Area,
    film::SIGNATURE,
    preview, refine,
    render::{Control, RenderError},
    scene::{self, Scene},
    tracer::World,
};

/// Renders the scene at the start and after every save, until Ctrl-C.
pub fn run(args: &WatchArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
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
        .map_err(|error| Trouble(format!("cannot watch the folder of {scene}: {error}")))?;
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
            .map_err(|error| Trouble(format!("cannot read {scene}: {error}")))
            .and_then(|bytes| render_and_write(args, bytes, &output, latest.stale(), &mut screen));
        match written {
            Ok(None) => {}
            Ok(Some(done)) => {
                let (since, what) = if is_first {
                    (start, "after the start")
                } else {
                    (content.since, "after the save")
                };
                let time = time(done.duration_since(since));
                screen.print(&format!("wrote {output} {time} {what}\n"));
            }
            // Watching continues after any error, since the cause may be gone at the next save.
            Err(trouble) => screen.print(&output::worded_error(&trouble)),
        }
        is_first = false;
    }
    Ok(Status::Interrupted)
}

/// Interval at which the terminal's size is checked while the file does not change. If the size has
/// changed, the picture is drawn again.
const REFIT: Duration = Duration::from_millis(200);

/// Returns the file to which the picture is written.
fn output(args: &WatchArgs) -> Result<PictureOutput, Trouble> {
    if input::is_standard(&args.scene) {
        return Err(Trouble(
            "standard input cannot be watched: it is read once; give a file".to_owned(),
        ));
    }
    match PictureOutput::of(&args.scene, args.output.as_deref())? {
        PictureOutput::Standard => Err(Trouble(
            "standard output holds one picture, and watch writes one after every save: give a file"
                .to_owned(),
        )),
        file => Ok(file),
    }
}

/// Checks that the scene can be read and is not a picture. This is checked only at the start, since
/// later the file may be missing for a time.
pub fn check_scene(scene: &Path) -> Result<(), Trouble> {
    let bytes = input::bytes(scene).map_err(|error| input::unreadable(scene, &error))?;
    check_text(scene, &bytes)
}

fn check_text(scene: &Path, bytes: &[u8]) -> Result<(), Trouble> {
    if bytes.starts_with(&SIGNATURE) {
        return Err(Trouble(format!(
            "{} is a picture, and what is watched is a text that somebody edits: `render` takes pictures",
            shown(scene)
        )));
    }
    Ok(())
}

/// Renders the text `bytes` and writes its picture. Returns the time at which the picture was
/// written. Returns `None` if the text has errors or a newer text has arrived.
fn render_and_write(
    args: &WatchArgs,
    bytes: Vec<u8>,
    output: &PictureOutput,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<Option<Instant>, Trouble> {
    check_text(&args.scene, &bytes)?;
    let input = SceneInput::of(&args.scene, bytes, &args.overrides);
    let Ok(reading) = scene::read_unless(&input.sources, is_stale) else {
        return Ok(None);
    };
    screen.print(&input.report(&reading));
    let Some(scene) = reading.scene else {
        return Ok(None);
    };
    let picture = match with_sketch(&scene, output.keep(), is_stale, screen) {
        Ok(picture) => picture,
        Err(RenderError::Cancelled) => return Ok(None),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let recipe = input.recipe(None);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let written = output.write(&args.scene, &picture, &recipe, whole, is_stale);
    if written.is_err() && is_stale.load(Ordering::SeqCst) {
        return Ok(None);
    }
    let done = Instant::now();
    let notes = picture.notes(whole, output);
    // The picture is shown even if it could not be written.
    if let Some(film) = picture.into_film() {
        screen.draw(film);
    }
    written?;
    screen.print(&output.note_of_length(&recipe));
    screen.print(&notes);
    Ok(Some(done))
}

/// Time that a render may take before coarse pictures are shown meanwhile.
const PATIENCE: Duration = Duration::from_millis(200);

/// Renders the scene. If this takes longer than [`PATIENCE`], shows increasingly fine pictures
/// meanwhile.
fn with_sketch(
    scene: &Scene,
    keep: KeptPixels,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<RenderedPicture, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let world = World::new_unless(scene, is_stale)?;
    let Some(side) = screen.side(whole) else {
        return picture(scene, &world, whole, keep, is_stale);
    };
    thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        scope.spawn({
            let world = &world;
            move || {
                if wait.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
                let control = Control {
                    threads: None,
                    progress: &|_| {},
                    cancel: is_stale,
                };
                // A cancelled coarse picture is not reported here, since the render of the picture
                // itself reports the cancellation.
                let _ = refine::coarse_to_fine(world, whole, side, &control, |sketch| {
                    screen.draw(sketch.film);
                });
            }
        });
        let picture = picture(scene, &world, whole, KeptPixels::Light, is_stale);
        drop(done);
        picture
    })
}

/// Formats a waiting time: in milliseconds if it is below a second, otherwise in seconds.
fn time(waited: Duration) -> String {
    match waited.as_secs_f64() {
        seconds if seconds < 1.0 => format!("{:.0} ms", seconds * 1e3),
        seconds => format!("{seconds:.2} s"),
    }
}
