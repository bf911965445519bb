//! `watch`: a scene is rendered whenever its file is saved.

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
    input::{self, Input, shown},
    interrupt::Interrupt,
    output,
    picture::{Keep, Output, Picture, picture},
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

/// Renders at the start and after every save, until Ctrl-C.
pub fn run(args: &WatchArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let start = Instant::now();
    let output = output(args)?;
    check_scene(&args.scene)?;
    output.check(&args.scene)?;
    let mut screen = match args.show {
        true => Screen::of_pictures()?,
        false => Screen::of_words(),
    };
    let scene = shown(&args.scene);
    let latest = preview::watch(&args.scene, input::bytes)
        .map_err(|error| Trouble(format!("cannot watch the folder of {scene}: {error}")))?;
    let ended = Arc::clone(&latest);
    interrupt.then(move || ended.end());
    screen.say(&format!("watching {scene}; Ctrl-C ends it\n"));
    let mut is_first = true;
    while let Some(content) = latest.take_while(REFIT, || screen.fit()) {
        if !is_first {
            screen.begin();
        }
        let made = content
            .bytes
            .map_err(|error| Trouble(format!("cannot read {scene}: {error}")))
            .and_then(|bytes| make(args, bytes, &output, latest.stale(), &mut screen));
        match made {
            Ok(None) => {}
            Ok(Some(done)) => {
                let (since, what) = match is_first {
                    true => (start, "after the start"),
                    false => (content.since, "after the save"),
                };
                let time = time(done.duration_since(since));
                screen.say(&format!("wrote {output} {time} {what}\n"));
            }
            // Whatever it is, the next save may find it gone.
            Err(trouble) => screen.say(&output::worded_error(&trouble)),
        }
        is_first = false;
    }
    Ok(Status::Interrupted)
}

/// How often the size of the terminal is looked at while nothing happens.
const REFIT: Duration = Duration::from_millis(200);

/// The file that the picture goes to.
fn output(args: &WatchArgs) -> Result<Output, Trouble> {
    if input::is_standard(&args.scene) {
        return Err(Trouble(
            "standard input cannot be watched: it is read once; give a file".to_owned(),
        ));
    }
    match Output::of(&args.scene, args.output.as_deref())? {
        Output::Standard => Err(Trouble(
            "standard output holds one picture, and watch writes one after every save: give a file"
                .to_owned(),
        )),
        file => Ok(file),
    }
}

/// What can be known at the start: later, files come and go.
pub fn check_scene(scene: &Path) -> Result<(), Trouble> {
    let bytes = input::bytes(scene).map_err(|error| input::unreadable(scene, &error))?;
    check_text(scene, &bytes)
}

fn check_text(scene: &Path, bytes: &[u8]) -> Result<(), Trouble> {
    match bytes.starts_with(&SIGNATURE) {
        false => Ok(()),
        true => Err(Trouble(format!(
            "{} is a picture, and what is watched is a text that somebody edits: `render` takes pictures",
            shown(scene)
        ))),
    }
}

/// Makes the picture of a text; answers when it was written. None is made of a text with mistakes,
/// nor when there is a newer one.
fn make(
    args: &WatchArgs,
    bytes: Vec<u8>,
    output: &Output,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<Option<Instant>, Trouble> {
    check_text(&args.scene, &bytes)?;
    let input = Input::of(&args.scene, bytes, &args.overrides);
    let Ok(reading) = scene::read_unless(&input.sources, is_stale) else {
        return Ok(None);
    };
    screen.say(&input.report(&reading));
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
    // Also one that cannot be written can be seen.
    if let Some(film) = picture.into_film() {
        screen.draw(film);
    }
    written?;
    screen.say(&output.note_of_length(&recipe));
    screen.say(&notes);
    Ok(Some(done))
}

/// A picture that takes longer is sketched first, ever finer.
const PATIENCE: Duration = Duration::from_millis(200);

/// Renders the scene, and shows coarse pictures where people would wait.
fn with_sketch(
    scene: &Scene,
    keep: Keep,
    is_stale: &AtomicBool,
    screen: &mut Screen,
) -> Result<Picture, RenderError> {
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
                // Cancelled, it has nothing more to show, and the picture's own end says so.
                let _ = refine::coarse_to_fine(world, whole, side, &control, |sketch| {
                    screen.draw(sketch.film);
                });
            }
        });
        let picture = picture(scene, &world, whole, Keep::Light, is_stale);
        drop(done);
        picture
    })
}

/// A time that somebody waited.
fn time(waited: Duration) -> String {
    match waited.as_secs_f64() {
        seconds if seconds < 1.0 => format!("{:.0} ms", seconds * 1e3),
        seconds => format!("{seconds:.2} s"),
    }
}
