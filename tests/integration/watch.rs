//! `watch` from outside: an editor's ways to save, broken texts, bursts, and the end.
//!
//! Every step waits for what it is to bring about, with a patience that a busy machine does not
//! exhaust; fixed times pass only where nothing is to happen.

use std::{
    cell::RefCell,
    fs,
    os::unix::fs::symlink,
    path::PathBuf,
    process::{Child, Command},
    thread,
    time::{Duration, Instant},
};

use pinhole::schema::css;
use tempfile::NamedTempFile;

use crate::{cancel::spheres, interrupt::long_pixel, program::Folder};

const PATIENCE: Duration = Duration::from_secs(60);

/// A picture of one colour.
fn scene(color: &str) -> String {
    format!(
        "image {{ width 8  height 6  background {color} }}\ncamera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}\n\
         sphere {{ center (0, 1, -1000)  radius 0.001 }}\n"
    )
}

/// A scene in red, in `a.scn`.
fn red() -> Folder {
    Folder::with([("a.scn", scene("red").as_str())])
}

/// A running `watch` in a folder of its own.
struct Watch {
    folder: Folder,
    child: RefCell<Child>,
    said: NamedTempFile,
}

impl Watch {
    /// Of a red picture, which is there.
    fn of_red() -> Self {
        let watch = Self::start(red(), "a.scn");
        watch.shows("red");
        watch
    }

    fn start(folder: Folder, arguments: &str) -> Self {
        let mut command = folder.command(&format!("watch {arguments}"));
        let said = NamedTempFile::new().unwrap();
        let child = command.stderr(said.reopen().unwrap()).spawn().unwrap();
        Self {
            folder,
            child: child.into(),
            said,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path(name)
    }

    fn save(&self, text: &str) {
        self.folder.write("a.scn", text);
    }

    /// Puts a file with such a text in the scene's place.
    fn replace(&self, text: &str) {
        self.folder.write("new", text);
        fs::rename(self.path("new"), self.path("a.scn")).unwrap();
    }

    /// Saves a picture of one colour, and waits for it.
    #[track_caller]
    fn becomes(&self, color: &str) {
        self.save(&scene(color));
        self.shows(color);
    }

    fn said(&self) -> String {
        let said = fs::read(self.said.path()).unwrap();
        String::from_utf8_lossy(&said).into_owned()
    }

    /// How often something was said.
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

    /// Waits until something is said so often.
    #[track_caller]
    fn says(&self, words: &str, times: usize) {
        self.wait(words, || self.count(words) == times);
    }

    /// Waits for a colour of the picture.
    #[track_caller]
    fn shows(&self, color: &str) {
        self.wait(color, || self.has("a.png", color));
    }

    /// Whether a picture, which is whole if it is there, has this colour in its first pixel.
    fn has(&self, name: &str, color: &str) -> bool {
        fs::read(self.path(name)).is_ok_and(|bytes| {
            let picture = image::load_from_memory(&bytes).expect("a picture is always whole");
            picture.to_rgb8().get_pixel(0, 0).0 == css::color(color).unwrap().to_bytes()
        })
    }

    /// Interrupts it: it ends as an interrupted program does, and leaves nothing but the picture.
    fn end(&self) {
        let mut kill = Command::new("kill");
        let sent = kill
            .args(["-INT", &self.child.borrow().id().to_string()])
            .status();
        assert!(sent.unwrap().success());
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
fn editors_that_save_by_renaming_are_seen() {
    let watch = Watch::of_red();
    // A new file is written and takes the place of the old one.
    watch.replace(&scene("blue"));
    watch.shows("blue");
    // The old file is renamed to a backup, and a new one is written.
    fs::rename(watch.path("a.scn"), watch.path("a.scn~")).unwrap();
    watch.becomes("lime");
    // And once more, for what was watched may be the file that is the backup now.
    watch.becomes("red");
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
    // A pipe in the file's place is waited out.
    let made = Command::new("mkfifo").arg(watch.path("pipe")).status();
    assert!(made.unwrap().success());
    fs::rename(watch.path("pipe"), watch.path("a.scn")).unwrap();
    watch.wait("it says so", || watch.count("it is a pipe, not a file") > 0);
    watch.replace(&scene("blue"));
    watch.shows("blue");
}

#[test]
fn a_file_or_folder_that_is_gone_may_come_back() {
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
    // Nobody watches the folder of the link in the middle: what no event tells is seen, however
    // much else happens.
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
    // Nothing older comes after it.
    let said = watch.count("wrote");
    watch.becomes("blue");
    watch.wait("it is written", || watch.count("wrote") > said);
    assert!(watch.has("a.png", "blue"));
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn what_is_superseded_is_given_up_and_so_is_what_ctrl_c_ends() {
    // It takes seconds to read, and something is said of it then.
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
fn what_is_no_save_makes_no_picture() {
    let watch = Watch::of_red();
    watch.says("wrote", 1);
    watch.folder.write("other.txt", "not a scene");
    // As editors do behind a save, and whoever reads the file.
    let permissions = fs::metadata(watch.path("a.scn")).unwrap().permissions();
    fs::set_permissions(watch.path("a.scn"), permissions).unwrap();
    watch.folder.read("a.scn");
    // Longer than the quiet that ends a burst.
    thread::sleep(Duration::from_millis(100));
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("wrote") >= 2);
    assert_eq!(watch.count("wrote"), 2, "{}", watch.said());
}

#[test]
fn a_save_of_the_text_that_was_there_is_a_save() {
    let watch = Watch::of_red();
    watch.says("after the start", 1);
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.becomes("red");
    watch.says("after the save", 1);
    // By another file in its place.
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.replace(&scene("red"));
    watch.shows("red");
    watch.says("after the save", 2);
    for times in 1..=2 {
        watch.save(&scene("red").replace("width", "widht"));
        watch.says("1 error\n", times);
    }
    // Each save is one rendering, in however many events it comes.
    assert_eq!(watch.count("wrote"), 3, "{}", watch.said());
}

#[test]
fn the_picture_is_that_of_render() {
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

#[test]
fn a_picture_that_cannot_be_written_is_no_end() {
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
