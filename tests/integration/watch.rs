//! `watch` from outside: an editor's ways to save, broken texts, bursts, and the end.
//!
//! Nothing sleeps for a fixed time: every step waits for what it is to bring about, with a patience that a busy machine does not
//! exhaust.

use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

use crate::{cancel::spheres, interrupt::long_pixel, program::Folder, table::rows};

const PATIENCE: Duration = Duration::from_secs(60);

/// A picture of one colour.
fn scene(color: &str) -> String {
    format!(
        "image {{ width 8  height 6  background {color} }}\ncamera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}\n\
         sphere {{ center (0, 1, -1000)  radius 0.001 }}\n"
    )
}

const RED: [u8; 3] = [255, 0, 0];
const BLUE: [u8; 3] = [0, 0, 255];

fn rgb(color: &str) -> [u8; 3] {
    pinhole::schema::css::color(color).unwrap().to_bytes()
}

/// A running `watch` of `a.scn` in a folder of its own.
struct Watch {
    folder: Folder,
    child: Child,
    said: Arc<Mutex<String>>,
}

impl Watch {
    /// Of a picture of one colour, which is there.
    fn of(color: &str) -> Self {
        let watch = Self::start(Folder::with([("a.scn", scene(color).as_str())]), "a.scn");
        watch.wait_for(rgb(color));
        watch
    }

    fn start(folder: Folder, arguments: &str) -> Self {
        let mut command = folder.command(&format!("watch {arguments}"));
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut errors = child.stderr.take().unwrap();
        let said = Arc::new(Mutex::new(String::new()));
        thread::spawn({
            let said = Arc::clone(&said);
            move || {
                let mut bytes = [0; 4096];
                while let Ok(count @ 1..) = errors.read(&mut bytes) {
                    let text = String::from_utf8_lossy(&bytes[..count]);
                    said.lock().unwrap().push_str(&text);
                }
            }
        });
        Self {
            folder,
            child,
            said,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path(name)
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
        self.wait_for(rgb(color));
    }

    fn save(&self, text: &str) {
        self.folder.write("a.scn", text);
    }

    fn said(&self) -> String {
        self.said.lock().unwrap().clone()
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

    #[track_caller]
    fn wait_for(&self, color: [u8; 3]) {
        self.wait("the picture has its colour", || {
            self.color("a.png") == Some(color)
        });
    }

    /// The colour of the first pixel of a picture, which is whole if it is there.
    fn color(&self, name: &str) -> Option<[u8; 3]> {
        let bytes = fs::read(self.path(name)).ok()?;
        let picture = image::load_from_memory(&bytes).expect("a picture is always whole");
        Some(picture.to_rgb8().get_pixel(0, 0).0)
    }

    /// Interrupts it: it ends as an interrupted program does, and leaves nothing but the picture.
    fn end(&mut self) {
        let mut kill = Command::new("kill");
        let sent = kill.args(["-INT", &self.child.id().to_string()]).status();
        assert!(sent.unwrap().success());
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "it goes on:\n{}", self.said());
            thread::sleep(Duration::from_millis(5));
        };
        assert_eq!(status.code(), Some(130));
        assert_eq!(self.folder.names(), ["a.png", "a.scn"]);
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_picture_follows_every_save_and_ctrl_c_ends_it() {
    let mut watch = Watch::of("red");
    watch.wait("it says so", || watch.count("after the start") == 1);
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("after the save") == 1);
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
    let watch = Watch::of("red");
    // A new file is written and takes the place of the old one.
    watch.replace(&scene("blue"));
    watch.wait_for(BLUE);
    // The old file is renamed to a backup, and a new one is written.
    fs::rename(watch.path("a.scn"), watch.path("a.scn~")).unwrap();
    watch.becomes("lime");
    // And once more, for what was watched may be the file that is the backup now.
    watch.becomes("red");
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn a_file_or_folder_that_is_gone_may_come_back() {
    let folder = Folder::with([("scenes/a.scn", scene("red").as_str())]);
    let watch = Watch::start(folder, "scenes/a.scn -o a.png");
    watch.wait_for(RED);
    let becomes = |color: &str| {
        watch.folder.write("scenes/a.scn", scene(color));
        watch.wait_for(rgb(color));
    };
    fs::remove_file(watch.path("scenes/a.scn")).unwrap();
    watch.wait("it is missed", || watch.count("error: cannot read") == 1);
    assert_eq!(watch.color("a.png"), Some(RED));
    becomes("lime");
    fs::remove_dir_all(watch.path("scenes")).unwrap();
    watch.wait("it is missed", || watch.count("error: cannot read") >= 2);
    becomes("blue");
    becomes("lime");
}

/// A watch of a link to a red scene elsewhere, which lies beside a blue one.
fn watch_link(link: impl Fn(&Path)) -> (Folder, Watch) {
    let far = Folder::with([]);
    for color in ["red", "blue"] {
        far.write(color, scene(color));
    }
    link(&far.path("."));
    let folder = Folder::with([]);
    std::os::unix::fs::symlink(far.path("link"), folder.path("a.scn")).unwrap();
    let watch = Watch::start(folder, "a.scn");
    watch.wait_for(RED);
    (far, watch)
}

#[test]
fn a_link_and_the_file_at_its_end_are_watched() {
    let (far, watch) = watch_link(|far| {
        fs::rename(far.join("red"), far.join("link")).unwrap();
    });
    far.write("link", scene("blue"));
    watch.wait_for(BLUE);
    fs::remove_file(watch.path("a.scn")).unwrap();
    watch.becomes("lime");
}

#[test]
fn what_no_event_tells_is_seen_however_much_else_happens() {
    use std::os::unix::fs::symlink;
    let middle = Folder::with([]);
    let (far, watch) = watch_link(|far| {
        symlink(far.join("red"), middle.path("middle")).unwrap();
        symlink(middle.path("middle"), far.join("link")).unwrap();
    });
    // Nobody watches the folder of the link in the middle.
    symlink(far.path("blue"), middle.path("other")).unwrap();
    fs::rename(middle.path("other"), middle.path("middle")).unwrap();
    watch.wait("the picture is blue", || {
        watch.folder.write("noise", "");
        watch.color("a.png") == Some(BLUE)
    });
}

#[test]
fn a_pipe_in_the_files_place_is_waited_out() {
    let watch = Watch::of("red");
    let made = Command::new("mkfifo").arg(watch.path("pipe")).status();
    assert!(made.unwrap().success());
    fs::rename(watch.path("pipe"), watch.path("a.scn")).unwrap();
    watch.wait("it says so", || watch.count("it is not a file") > 0);
    watch.replace(&scene("blue"));
    watch.wait_for(BLUE);
}

#[test]
fn broken_text_is_reported_and_the_last_picture_stays() {
    let watch = Watch::start(Folder::with([("a.scn", "sphere {")]), "a.scn");
    watch.wait("it is reported", || watch.count("2 errors\n") == 1);
    assert_eq!(watch.color("a.png"), None);
    watch.becomes("red");
    let good = fs::read(watch.path("a.png")).unwrap();
    watch.save(&scene("blue").replace("width", "widht"));
    let report = "error[pinhole::unknown_field]: an image has no field `widht`";
    watch.wait("the mistake is reported", || watch.count(report) == 1);
    watch.wait("the report is whole", || watch.count("1 error\n") == 1);
    assert!(fs::read(watch.path("a.png")).unwrap() == good);
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("after the save") == 2);
}

#[test]
fn a_burst_of_saves_ends_with_the_last_ones_picture() {
    let watch = Watch::of("red");
    for round in 0..100 {
        watch.save(&scene(["navy", "teal", "gold", "plum"][round % 4]));
    }
    watch.becomes("lime");
    // Nothing older comes after it.
    let said = watch.count("wrote");
    watch.becomes("blue");
    watch.wait("it is written", || watch.count("wrote") > said);
    assert_eq!(watch.color("a.png"), Some(BLUE));
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn what_is_superseded_is_cancelled_within_a_pixel() {
    let folder = Folder::with([("a.scn", scene("red").as_str())]);
    let mut watch = Watch::start(folder, "a.scn --threads 1");
    watch.wait_for(RED);
    watch.save(&long_pixel());
    thread::sleep(Duration::from_millis(500));
    watch.becomes("blue");
    watch.save(&long_pixel());
    thread::sleep(Duration::from_millis(500));
    let start = Instant::now();
    watch.end();
    assert!(start.elapsed() < Duration::from_millis(900));
}

#[test]
fn what_is_superseded_is_not_read_to_its_end_nor_what_ctrl_c_ends() {
    // It takes seconds to read, and something is said of it then.
    let long = format!("{}sphere {{ radus 2 }}", spheres(400_000));
    let mut watch = Watch::of("red");
    watch.save(&long);
    thread::sleep(Duration::from_millis(300));
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("after the save") == 1);
    watch.save(&long);
    thread::sleep(Duration::from_millis(300));
    watch.end();
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn what_is_no_save_makes_no_picture() {
    let watch = Watch::of("red");
    watch.wait("it says so", || watch.count("wrote") == 1);
    watch.folder.write("other.txt", "not a scene");
    // As editors do behind a save, and whoever reads the file.
    let permissions = fs::metadata(watch.path("a.scn")).unwrap().permissions();
    fs::set_permissions(watch.path("a.scn"), permissions).unwrap();
    fs::read(watch.path("a.scn")).unwrap();
    // Longer than the quiet that ends a burst.
    thread::sleep(Duration::from_millis(100));
    watch.becomes("blue");
    watch.wait("it says so", || watch.count("wrote") >= 2);
    assert_eq!(watch.count("wrote"), 2, "{}", watch.said());
}

#[test]
fn a_save_of_the_text_that_was_there_is_a_save() {
    let watch = Watch::of("red");
    watch.wait("it is written", || watch.count("after the start") == 1);
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.becomes("red");
    watch.wait("it says so", || watch.count("after the save") == 1);
    // By another file in its place.
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.replace(&scene("red"));
    watch.wait_for(RED);
    watch.wait("it says so", || watch.count("after the save") == 2);
    for times in 1..=2 {
        watch.save(&scene("red").replace("width", "widht"));
        watch.wait("it is reported", || watch.count("1 error\n") == times);
    }
    // Each save is one rendering, in however many events it comes.
    assert_eq!(watch.count("wrote"), 3, "{}", watch.said());
}

#[test]
fn the_picture_is_that_of_render() {
    let arguments = "a.scn --set image.width=32 --threads 2";
    for name in ["a.png", "b.exr"] {
        let folder = Folder::with([("a.scn", scene("red").as_str())]);
        let watch = Watch::start(folder, &format!("{arguments} -o {name}"));
        watch.wait("it is written", || watch.count("wrote") == 1);
        let picture = watch.folder.read(name);
        watch
            .folder
            .done(&format!("render {arguments} -o c.{name}"));
        assert!(watch.folder.read(&format!("c.{name}")) == picture, "{name}");
    }
}

#[test]
fn a_picture_that_cannot_be_written_is_no_end() {
    let folder = Folder::with([("a.scn", scene("red").as_str()), ("out/kept", "")]);
    let watch = Watch::start(folder, "a.scn -o out/a.png");
    watch.wait("it is written", || watch.count("wrote") == 1);
    fs::remove_dir_all(watch.path("out")).unwrap();
    watch.save(&scene("blue"));
    let error = "error: cannot write to out/a.png: ";
    watch.wait("it is told", || watch.count(error) == 1);
    fs::create_dir(watch.path("out")).unwrap();
    watch.save(&scene("lime"));
    let is_there = || watch.color("out/a.png") == Some(rgb("lime"));
    watch.wait("it is written again", is_there);
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let folder = Folder::with([("a.scn", scene("red").as_str())]);
    folder.done("render a.scn");
    let table = "
        - -> standard input cannot be watched
        a.scn -o - -> standard output holds one picture
        a.png -o b.png -> a.png is a picture, and what is watched is a text
        none.scn -> cannot read none.scn:
        . -> . is not a file
        a.scn -o a.jpg -> the ending of a.jpg stands for no format
        a.scn -o none/a.png -> cannot write to none/a.png:
        a.scn --show -> `--show` draws in a terminal
    ";
    for [arguments, says] in rows(table) {
        let told = folder.told(&format!("watch {arguments}"), 2);
        assert!(told.starts_with(&format!("error: {says}")), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
}
