//! Tests of `pinhole watch` as a user runs it: the ways in which editors save, texts with errors,
//! bursts of saves, and Ctrl-C.
//!
//! Each step waits for its effect. The timeout is long enough for a busy machine. A test waits for
//! a fixed time only if nothing should happen.

use std::{
    cell::RefCell,
    fs, io,
    os::unix::fs::symlink,
    path::PathBuf,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use pinhole::schema::css;
use tempfile::NamedTempFile;

use crate::{
    cancel::spheres,
    interrupt::{long_pixel, send_signal},
    program::Folder,
};

const PATIENCE: Duration = Duration::from_secs(60);

/// Returns a scene whose picture has the single colour `color`.
fn scene(color: &str) -> String {
    format!(
        "image {{ width 8  height 6  background {color} }}\ncamera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}\n\
         sphere {{ center (0, 1, -1000)  radius 0.001 }}\n"
    )
}

/// Returns a folder with a scene in `a.scn` whose picture is red.
fn red() -> Folder {
    Folder::with([("a.scn", scene("red").as_str())])
}

/// A running `pinhole watch`, in its own folder.
struct Watch {
    folder: Folder,
    child: RefCell<Child>,
    said: NamedTempFile,
}

impl Watch {
    /// Starts watching a scene whose picture is red, and waits for the picture.
    fn of_red() -> Self {
        let watch = Self::start(red(), "a.scn");
        watch.shows("red");
        watch
    }

    fn start(folder: Folder, arguments: &str) -> Self {
        let command = folder.command(&format!("watch {arguments}"));
        Self::of(folder, command).unwrap()
    }

    fn of(folder: Folder, mut command: Command) -> io::Result<Self> {
        let said = NamedTempFile::new()?;
        let output = said.reopen()?;
        let command = command.stdout(output.try_clone()?).stderr(output);
        let child = command.spawn()?.into();
        Ok(Self {
            folder,
            child,
            said,
        })
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path(name)
    }

    fn save(&self, text: &str) {
        self.folder.write("a.scn", text);
    }

    /// Saves a new file and renames it to the name of the scene's file, as some editors do.
    fn replace(&self, text: &str) {
        self.folder.write("new", text);
        fs::rename(self.path("new"), self.path("a.scn")).unwrap();
    }

    /// Saves a scene whose picture has the colour `color`, and waits for the picture.
    #[track_caller]
    fn becomes(&self, color: &str) {
        self.save(&scene(color));
        self.shows(color);
    }

    fn said(&self) -> String {
        let said = fs::read(self.said.path()).unwrap();
        String::from_utf8_lossy(&said).into_owned()
    }

    /// Returns how many times the program has printed `words`.
    fn count(&self, words: &str) -> usize {
        self.said().matches(words).count()
    }

    #[track_caller]
    fn wait(&self, what: &str, is_so: impl Fn() -> bool) {
        let start = Instant::now();
        while !is_so() {
            let said = self.said();
            assert!(start.elapsed() < PATIENCE, "{what}; it says:\n{said}");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until the program has printed `words` exactly `times` times.
    #[track_caller]
    fn says(&self, words: &str, times: usize) {
        self.wait(words, || self.count(words) == times);
    }

    /// Waits until the picture has the colour `color`.
    #[track_caller]
    fn shows(&self, color: &str) {
        self.wait(color, || self.has("a.png", color));
    }

    /// Returns whether a picture exists and its first pixel has the colour `color`. Panics if the
    /// file is not a complete picture.
    fn has(&self, name: &str, color: &str) -> bool {
        fs::read(self.path(name)).is_ok_and(|bytes| {
            let picture = image::load_from_memory(&bytes).expect("a picture is always whole");
            picture.to_rgb8().get_pixel(0, 0).0 == css::color(color).unwrap().to_bytes()
        })
    }

    /// Interrupts the program. Asserts that it ends with the exit status for an interruption, and
    /// leaves only the picture.
    fn end(&self) {
        send_signal("INT", &self.child.borrow());
        let ended = || self.child.borrow_mut().try_wait().unwrap();
        self.wait("it ends", || ended().is_some());
        assert_eq!(ended().unwrap().code(), Some(130));
        assert_eq!(self.folder.names(), ["a.png", "a.scn"]);
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let child = self.child.get_mut();
        let _ = child.kill();
        let _ = child.wait();
    }
}

#[test]
fn a_picture_follows_every_save_and_ctrl_c_ends_it() {
    let watch = Watch::of_red();
    watch.says("after the start", 1);
    watch.becomes("blue");
    watch.says("after the save", 1);
    watch.end();
    let said = watch.said();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "watching a.scn; Ctrl-C ends it");
    assert!(lines[1].starts_with("wrote a.png ") && lines[1].ends_with(" ms after the start"));
    assert!(lines[2].starts_with("wrote a.png ") && lines[2].ends_with("s after the save"));
    assert_eq!(lines.len(), 3, "{said}");
}

#[test]
fn saves_by_renaming_and_a_pipe_in_between_are_noticed() {
    let watch = Watch::of_red();
    // Some editors write a new file, which then replaces the old one.
    watch.replace(&scene("blue"));
    watch.shows("blue");
    // Other editors rename the old file to a backup, then write a new one.
    fs::rename(watch.path("a.scn"), watch.path("a.scn~")).unwrap();
    watch.becomes("lime");
    // This save is noticed only if the program watches the new file rather than the backup.
    watch.becomes("red");
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
    // If a pipe takes the place of the file, the program reports it and waits for a file.
    watch.folder.make_pipe("pipe");
    fs::rename(watch.path("pipe"), watch.path("a.scn")).unwrap();
    watch.wait("it says so", || watch.count("it is a pipe, not a file") > 0);
    watch.replace(&scene("blue"));
    watch.shows("blue");
}

#[test]
fn a_deleted_file_or_folder_is_watched_again_when_it_returns() {
    let folder = Folder::with([("scenes/a.scn", scene("red").as_str())]);
    let watch = Watch::start(folder, "scenes/a.scn -o a.png");
    watch.shows("red");
    let becomes = |color: &str| {
        watch.folder.write("scenes/a.scn", scene(color));
        watch.shows(color);
    };
    fs::remove_file(watch.path("scenes/a.scn")).unwrap();
    watch.says("error: cannot read", 1);
    assert!(watch.has("a.png", "red"));
    becomes("lime");
    fs::remove_dir_all(watch.path("scenes")).unwrap();
    watch.wait("it is missed", || watch.count("error: cannot read") >= 2);
    becomes("blue");
    becomes("lime");
}

#[test]
fn links_and_the_file_at_their_end_are_watched() {
    let (far, middle, folder) = (red(), Folder::with([]), Folder::with([]));
    far.write("blue", scene("blue"));
    symlink(far.path("a.scn"), middle.path("middle")).unwrap();
    symlink(middle.path("middle"), far.path("link")).unwrap();
    symlink(far.path("link"), folder.path("a.scn")).unwrap();
    let watch = Watch::start(folder, "a.scn");
    watch.shows("red");
    far.write("a.scn", scene("gold"));
    watch.shows("gold");
    // The path is a chain of three links. The folder of the middle link is not watched, so a change
    // of this link causes no event. The program notices the change when any other event occurs.
    symlink(far.path("blue"), middle.path("other")).unwrap();
    fs::rename(middle.path("other"), middle.path("middle")).unwrap();
    watch.wait("the picture is blue", || {
        watch.folder.write("noise", "");
        watch.has("a.png", "blue")
    });
    fs::remove_file(watch.path("a.scn")).unwrap();
    watch.becomes("lime");
}

#[test]
fn broken_text_is_reported_and_the_last_picture_stays() {
    let watch = Watch::start(Folder::with([("a.scn", "sphere {")]), "a.scn");
    watch.says("2 errors\n", 1);
    assert!(!watch.path("a.png").exists());
    watch.becomes("red");
    let good = watch.folder.read("a.png");
    watch.save(&scene("blue").replace("width", "widht"));
    watch.says(
        "error[pinhole::unknown_field]: an image has no field `widht`",
        1,
    );
    watch.says("1 error\n", 1);
    assert!(watch.folder.read("a.png") == good);
    watch.becomes("blue");
    watch.says("after the save", 2);
}

#[test]
fn a_burst_of_saves_ends_with_the_last_ones_picture() {
    let watch = Watch::of_red();
    for round in 0..100 {
        watch.save(&scene(["navy", "teal", "gold", "plum"][round % 4]));
    }
    watch.becomes("lime");
    // No picture of an older save may be written after the picture of the last save.
    let said = watch.count("wrote");
    watch.becomes("blue");
    watch.wait("it is written", || watch.count("wrote") > said);
    assert!(watch.has("a.png", "blue"));
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn a_new_save_or_ctrl_c_cancels_the_picture_in_progress() {
    // The text takes seconds to read, and has an error at its end.
    let long = format!("{}sphere {{ radus 2 }}", spheres(400_000));
    for slow in [long_pixel(), long] {
        let watch = Watch::start(red(), "a.scn --threads 1");
        watch.shows("red");
        watch.save(&slow);
        thread::sleep(Duration::from_millis(500));
        watch.becomes("blue");
        watch.says("after the save", 1);
        watch.save(&slow);
        thread::sleep(Duration::from_millis(500));
        let start = Instant::now();
        watch.end();
        assert!(start.elapsed() < Duration::from_millis(900));
        assert_eq!(watch.count("error"), 0, "{}", watch.said());
    }
}

#[test]
fn other_files_permissions_and_reads_trigger_no_picture() {
    let watch = Watch::of_red();
    watch.says("wrote", 1);
    watch.folder.write("other.txt", "not a scene");
    // Editors set permissions after a save, and other programs read the file. Neither causes a new
    // picture.
    let permissions = fs::metadata(watch.path("a.scn")).unwrap().permissions();
    fs::set_permissions(watch.path("a.scn"), permissions).unwrap();
    watch.folder.read("a.scn");
    // A picture caused by reading the file or setting its permissions would be written within a
    // short time. The test waits longer than this time. It then counts the pictures, including the
    // one of the next save.
    thread::sleep(Duration::from_millis(100));
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("wrote") >= 2);
    assert_eq!(watch.count("wrote"), 2, "{}", watch.said());
}

#[test]
fn saving_an_unchanged_text_renders_it_again() {
    let watch = Watch::of_red();
    watch.says("after the start", 1);
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.becomes("red");
    watch.says("after the save", 1);
    // The file is not written in place here. Instead, a new file is renamed to the name of the
    // scene's file, as some editors do.
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.replace(&scene("red"));
    watch.shows("red");
    watch.says("after the save", 2);
    for times in 1..=2 {
        watch.save(&scene("red").replace("width", "widht"));
        watch.says("1 error\n", times);
    }
    // Each save is rendered once, however many events it causes.
    assert_eq!(watch.count("wrote"), 3, "{}", watch.said());
}

#[test]
fn watch_writes_the_same_picture_as_render() {
    let arguments = "a.scn --set image.width=32 --threads 2";
    for name in ["a.png", "b.exr"] {
        let watch = Watch::start(red(), &format!("{arguments} -o {name}"));
        watch.says("wrote", 1);
        let picture = watch.folder.read(name);
        let line = format!("render {arguments} -o c.{name}");
        watch.folder.done(&line);
        assert!(watch.folder.read(&format!("c.{name}")) == picture, "{name}");
    }
}

/// The command `script` gives the program a terminal. Without `script`, nothing is tested.
#[test]
fn with_show_every_picture_is_drawn_in_the_terminal() {
    let folder = red();
    let line = format!("'{}' watch a.scn --show", env!("CARGO_BIN_EXE_pinhole"));
    let mut command = Command::new("script");
    command
        .args(["-qfec", &line, "/dev/null"])
        .current_dir(folder.path(""))
        .envs([("TERM", "xterm"), ("COLORTERM", "truecolor")])
        .env_remove("NO_COLOR")
        .env_remove("CLICOLOR")
        .stdin(Stdio::null());
    let Ok(watch) = Watch::of(folder, command) else {
        return;
    };
    for color in ["red", "olive"] {
        watch.save(&scene(color));
        let [r, g, b] = css::color(color).unwrap().to_bytes();
        let cell = format!("\x1b[38;2;{r};{g};{b}m\x1b[48;2;{r};{g};{b}m▀");
        watch.wait(color, || watch.count(&cell) > 0);
    }
}

#[test]
fn watch_continues_after_a_picture_cannot_be_written() {
    let folder = red();
    folder.write("out/kept", "");
    let watch = Watch::start(folder, "a.scn -o out/a.png");
    watch.says("wrote", 1);
    fs::remove_dir_all(watch.path("out")).unwrap();
    watch.save(&scene("blue"));
    watch.says("error: cannot write to out/a.png: ", 1);
    fs::create_dir(watch.path("out")).unwrap();
    watch.save(&scene("lime"));
    watch.wait("it is written again", || watch.has("out/a.png", "lime"));
}
