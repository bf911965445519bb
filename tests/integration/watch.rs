//! `watch` from outside: an editor's ways to save, broken texts, bursts, and the end.
//!
//! Nothing sleeps for a fixed time: every step waits for what it is to bring about, with a patience that a busy machine does not
//! exhaust.

use std::{
    fs,
    io::Read,
    path::PathBuf,
    process::{Child, Command, ExitStatus, Stdio},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

use tempfile::TempDir;

use crate::{
    cancel::spheres,
    interrupt::long_pixel,
    program::{command, names},
    table::rows,
};

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
const LIME: [u8; 3] = [0, 255, 0];

/// A running `watch` of `a.scn` in a folder of its own.
struct Watch {
    folder: TempDir,
    child: Child,
    said: Arc<Mutex<String>>,
}

impl Watch {
    fn start(text: &str, arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.scn"), text).unwrap();
        Self::start_in(folder, "a.scn", arguments)
    }

    fn start_in(folder: TempDir, scene: &str, arguments: &[&str]) -> Self {
        let mut child = command(folder.path(), &[&["watch", scene], arguments].concat())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
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
        self.folder.path().join(name)
    }

    fn save(&self, text: &str) {
        fs::write(self.path("a.scn"), text).unwrap();
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

    fn end(&mut self) -> ExitStatus {
        let sent = Command::new("kill")
            .args(["-INT", &self.child.id().to_string()])
            .status()
            .unwrap();
        assert!(sent.success());
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(start.elapsed() < PATIENCE, "it goes on:\n{}", self.said());
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn names(&self) -> Vec<String> {
        names(self.folder.path())
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
    let mut watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    watch.wait("it says so", || watch.count("after the start") == 1);
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.wait("it says so", || watch.count("after the save") == 1);
    assert_eq!(watch.end().code(), Some(130));
    assert_eq!(watch.names(), ["a.png", "a.scn"]);
    let said = watch.said();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "watching a.scn; Ctrl-C ends it");
    assert!(lines[1].starts_with("wrote a.png ") && lines[1].ends_with(" ms after the start"));
    assert!(lines[2].starts_with("wrote a.png ") && lines[2].ends_with("s after the save"));
    assert_eq!(lines.len(), 3, "{said}");
}

#[test]
fn editors_that_save_by_renaming_are_seen() {
    let watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    // A new file is written and takes the place of the old one.
    fs::write(watch.path(".a.scn.new"), scene("blue")).unwrap();
    fs::rename(watch.path(".a.scn.new"), watch.path("a.scn")).unwrap();
    watch.wait_for(BLUE);
    // The old file is renamed to a backup, and a new one is written.
    fs::rename(watch.path("a.scn"), watch.path("a.scn~")).unwrap();
    watch.save(&scene("lime"));
    watch.wait_for(LIME);
    // And once more, for what was watched may be the file that is the backup now.
    watch.save(&scene("red"));
    watch.wait_for(RED);
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn a_file_or_folder_that_is_gone_may_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("scenes");
    let fill = |color: &str| {
        fs::create_dir(&inner).unwrap();
        fs::write(inner.join("a.scn"), scene(color)).unwrap();
    };
    fill("red");
    let watch = Watch::start_in(folder, "scenes/a.scn", &["-o", "a.png"]);
    watch.wait_for(RED);
    fs::remove_file(inner.join("a.scn")).unwrap();
    watch.wait("it is missed", || watch.count("error: cannot read") == 1);
    assert_eq!(watch.color("a.png"), Some(RED));
    fs::write(inner.join("a.scn"), scene("lime")).unwrap();
    watch.wait_for(LIME);
    fs::remove_dir_all(&inner).unwrap();
    watch.wait("it is missed", || watch.count("error: cannot read") >= 2);
    fill("blue");
    watch.wait_for(BLUE);
    fs::write(inner.join("a.scn"), scene("lime")).unwrap();
    watch.wait_for(LIME);
}

#[test]
fn a_link_and_the_file_at_its_end_are_watched() {
    let folder = tempfile::tempdir().unwrap();
    let far = tempfile::tempdir().unwrap();
    let target = far.path().join("real.scn");
    fs::write(&target, scene("red")).unwrap();
    std::os::unix::fs::symlink(&target, folder.path().join("a.scn")).unwrap();
    let watch = Watch::start_in(folder, "a.scn", &[]);
    watch.wait_for(RED);
    fs::write(&target, scene("blue")).unwrap();
    watch.wait_for(BLUE);
    fs::remove_file(watch.path("a.scn")).unwrap();
    fs::write(watch.path("a.scn"), scene("lime")).unwrap();
    watch.wait_for(LIME);
}

#[test]
fn what_no_event_tells_is_seen_however_much_else_happens() {
    use std::os::unix::fs::symlink;
    let [folder, middle, far] = [(); 3].map(|()| tempfile::tempdir().unwrap());
    for color in ["red", "blue"] {
        fs::write(far.path().join(color), scene(color)).unwrap();
    }
    let link = middle.path().join("middle");
    symlink(far.path().join("red"), &link).unwrap();
    symlink(&link, folder.path().join("a.scn")).unwrap();
    let watch = Watch::start_in(folder, "a.scn", &[]);
    watch.wait_for(RED);
    // Nobody watches the folder of the link in the middle.
    let other = middle.path().join("other");
    symlink(far.path().join("blue"), &other).unwrap();
    fs::rename(&other, &link).unwrap();
    watch.wait("the picture is blue", || {
        fs::write(watch.path("noise"), "").unwrap();
        watch.color("a.png") == Some(BLUE)
    });
}

#[test]
fn a_pipe_in_the_files_place_is_waited_out() {
    let watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    let made = Command::new("mkfifo").arg(watch.path("pipe")).status();
    assert!(made.unwrap().success());
    fs::rename(watch.path("pipe"), watch.path("a.scn")).unwrap();
    watch.wait("it says so", || watch.count("it is not a file") > 0);
    fs::write(watch.path("new"), scene("blue")).unwrap();
    fs::rename(watch.path("new"), watch.path("a.scn")).unwrap();
    watch.wait_for(BLUE);
}

#[test]
fn broken_text_is_reported_and_the_last_picture_stays() {
    let watch = Watch::start("sphere {", &[]);
    watch.wait("it is reported", || watch.count("2 errors\n") == 1);
    assert_eq!(watch.color("a.png"), None);
    watch.save(&scene("red"));
    watch.wait_for(RED);
    let good = fs::read(watch.path("a.png")).unwrap();
    watch.save(&scene("blue").replace("width", "widht"));
    let report = "error[pinhole::unknown_field]: an image has no field `widht`";
    watch.wait("the mistake is reported", || watch.count(report) == 1);
    watch.wait("the report is whole", || watch.count("1 error\n") == 1);
    assert!(fs::read(watch.path("a.png")).unwrap() == good);
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.wait("it says so", || watch.count("after the save") == 2);
}

#[test]
fn a_burst_of_saves_ends_with_the_last_ones_picture() {
    let watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    for round in 0..100 {
        let color = ["navy", "teal", "gold", "plum"][round % 4];
        watch.save(&scene(color));
    }
    watch.save(&scene("lime"));
    watch.wait_for(LIME);
    // Nothing older comes after it.
    let said = watch.count("wrote");
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.wait("it is written", || watch.count("wrote") > said);
    assert_eq!(watch.color("a.png"), Some(BLUE));
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
}

#[test]
fn what_is_superseded_is_cancelled_within_a_pixel() {
    let mut watch = Watch::start(&scene("red"), &["--threads", "1"]);
    watch.wait_for(RED);
    watch.save(&long_pixel());
    thread::sleep(Duration::from_millis(500));
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.save(&long_pixel());
    thread::sleep(Duration::from_millis(500));
    let start = Instant::now();
    assert_eq!(watch.end().code(), Some(130));
    assert!(start.elapsed() < Duration::from_millis(900));
    assert_eq!(watch.names(), ["a.png", "a.scn"]);
}

/// A text that takes seconds to read, and of which something is said then.
fn long_text() -> String {
    format!("{}sphere {{ radus 2 }}", spheres(400_000))
}

#[test]
fn what_is_superseded_is_not_read_to_its_end_nor_what_ctrl_c_ends() {
    let mut watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    watch.save(&long_text());
    thread::sleep(Duration::from_millis(300));
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.wait("it says so", || watch.count("after the save") == 1);
    watch.save(&long_text());
    thread::sleep(Duration::from_millis(300));
    assert_eq!(watch.end().code(), Some(130));
    assert_eq!(watch.count("error"), 0, "{}", watch.said());
    assert_eq!(watch.names(), ["a.png", "a.scn"]);
}

#[test]
fn what_is_no_save_makes_no_picture() {
    let watch = Watch::start(&scene("red"), &[]);
    watch.wait_for(RED);
    watch.wait("it says so", || watch.count("wrote") == 1);
    fs::write(watch.path("other.txt"), "not a scene").unwrap();
    // As editors do behind a save, and whoever reads the file.
    let permissions = fs::metadata(watch.path("a.scn")).unwrap().permissions();
    fs::set_permissions(watch.path("a.scn"), permissions).unwrap();
    fs::read(watch.path("a.scn")).unwrap();
    // Longer than the quiet that ends a burst.
    thread::sleep(Duration::from_millis(100));
    watch.save(&scene("blue"));
    watch.wait_for(BLUE);
    watch.wait("it says so", || watch.count("wrote") >= 2);
    assert_eq!(watch.count("wrote"), 2, "{}", watch.said());
}

#[test]
fn a_save_of_the_text_that_was_there_is_a_save() {
    let watch = Watch::start(&scene("red"), &[]);
    watch.wait("it is written", || watch.count("after the start") == 1);
    fs::remove_file(watch.path("a.png")).unwrap();
    watch.save(&scene("red"));
    watch.wait_for(RED);
    watch.wait("it says so", || watch.count("after the save") == 1);
    // By another file in its place.
    fs::remove_file(watch.path("a.png")).unwrap();
    fs::write(watch.path("new"), scene("red")).unwrap();
    fs::rename(watch.path("new"), watch.path("a.scn")).unwrap();
    watch.wait_for(RED);
    watch.wait("it says so", || watch.count("after the save") == 2);
    let broken = scene("red").replace("width", "widht");
    for times in 1..=2 {
        watch.save(&broken);
        watch.wait("the mistake is reported", || {
            watch.count("1 error\n") == times
        });
    }
    // Each save is one rendering, in however many events it comes.
    assert_eq!(watch.count("wrote"), 3, "{}", watch.said());
}

#[test]
fn the_picture_is_that_of_render() {
    let arguments = ["--set", "image.width=32", "--threads", "2"];
    let exr = [&arguments[..], &["-o", "b.exr"]].concat();
    for (name, arguments) in [("a.png", &arguments[..]), ("b.exr", &exr)] {
        let watch = Watch::start(&scene("red"), arguments);
        watch.wait("it is written", || watch.count("wrote") == 1);
        let picture = fs::read(watch.path(name)).unwrap();
        let render = [&["render", "a.scn"], arguments].concat();
        fs::remove_file(watch.path(name)).unwrap();
        let status = command(watch.folder.path(), &render).status().unwrap();
        assert!(status.success());
        assert!(fs::read(watch.path(name)).unwrap() == picture, "{name}");
    }
}

#[test]
fn a_picture_that_cannot_be_written_is_no_end() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), scene("red")).unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let watch = Watch::start_in(folder, "a.scn", &["-o", "out/a.png"]);
    watch.wait("it is written", || watch.count("wrote") == 1);
    fs::remove_dir_all(&out).unwrap();
    watch.save(&scene("blue"));
    watch.wait("it is told", || {
        watch.count("error: cannot write to out/a.png: ") == 1
    });
    fs::create_dir(&out).unwrap();
    watch.save(&scene("lime"));
    watch.wait("it is written again", || {
        watch.color("out/a.png") == Some(LIME)
    });
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), scene("red")).unwrap();
    let status = command(folder.path(), &["render", "a.scn"])
        .status()
        .unwrap();
    assert!(status.success());
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
        let arguments: Vec<&str> = ["watch"].into_iter().chain(arguments.split(' ')).collect();
        let output = command(folder.path(), &arguments).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(errors.starts_with(&format!("error: {says}")), "{errors}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
        assert_eq!(output.stdout, b"");
    }
}
