//! Texts that each command's `--help` prints after the options: examples, the fields of JSON
//! output, and exit statuses.

pub const EXAMPLES: &str = "\
Examples:
  pinhole render figure.scn                      writes figure.png beside it
  pinhole render figure.scn -o big.exr --set image.width=3840 --set image.height=2160
  pinhole watch figure.scn                       and again whenever it is saved
  pinhole check *.scn
  pinhole inspect figure.scn --format json
  pinhole probe figure.scn 640.5 360.5
  pinhole diff mine.png figure.scn               is it the right picture, and if not, why?
  pinhole fmt *.scn

Exit status: 0 done, warnings or not; 1 the scene has errors, diff found more than its tolerance, or
fmt --check would change something; 2 usage, a file that cannot be read or written, a picture too large for memory; 130 after Ctrl-C.";

pub const RENDER_EXAMPLES: &str = "\
Examples:
  pinhole render figure.scn
  pinhole render figure.scn -o half.png --set camera.roll=30deg --set Ball.center='(0, 2, 0)'
  pinhole render figure.scn -o eyes.png --crop 600,200,80,40
  pinhole render figure.png -o again.png         renders the scene that the picture carries
  pinhole render figure.scn -o a.png --shard 1/8 the first of eight parts of the picture
  pinhole render figure.scn -o 'roll-%03d.png' --sweep camera.roll=0deg..90deg/91 --resume
  generate | pinhole render - -o - | view        from standard input to standard output";

pub const MERGE_EXAMPLES: &str = "\
Examples:
  pinhole merge part-*.png -o figure.png

Each part carries its place in the picture, and a digest of its scene, its --set arguments and the version of Pinhole. Parts \
that overlap, leave a gap, or are of different pictures or formats are refused by name. The order of the parts does not \
matter, and the whole picture is never in memory.";

pub const CHECK_EXAMPLES: &str = "\
Examples:
  pinhole check figure.scn
  pinhole check *.scn --format json              one line for each problem
  pinhole check figure.scn --fix                 and correct what can be corrected safely
  pinhole check figure.scn --fix --unsafe        and what has several meanings, in the likeliest one
  pinhole check figure.scn --fix --diff          and show the changes instead of writing them

Fixes are of three kinds. A safe one keeps all that was written, and there is one meaning: --fix applies these, again until \
nothing changes, says what it did and how many fixes it held back, and reports what is left. An unsafe one chooses among \
meanings, or removes or changes something: it takes --unsafe, too. A placeholder makes up a value, and no command applies \
it. A file is written whole or not at all; with -, the text goes to standard output.

JSON, an object a line: file, severity, code, message, help, labels [{offset, length, line, column, end_line, \
end_column, message}], fixes [{title, applicability, edits [{offset, length, text}]}]. The first label is the place to jump to. A fix \
is a way out that needs no other: each of its edits replaces length bytes at offset by text; offsets count in the text as it \
was. A label or an edit within a --set argument has a file of its own. Of a file with more than 1000 problems the last line says how many more there are.";

pub const WATCH_EXAMPLES: &str = "\
Examples:
  pinhole watch figure.scn                       writes figure.png at once and after every save
  pinhole watch figure.scn --show                and draws it in the terminal
  pinhole watch figure.scn -o draft.png --set sampler.per_pixel=4

While the text has mistakes, they are reported, and the last picture stays. A picture that is not done when \
the text changes again is given up. Ctrl-C ends it, with status 130.";

pub const NEW_EXAMPLES: &str = "\
Examples:
  pinhole new figure.scn                         a ball on a floor; a file that is there already is left as it is
  pinhole new figure.scn && pinhole watch figure.scn --show";

pub const INSPECT_EXAMPLES: &str = "\
Examples:
  pinhole inspect figure.scn
  pinhole inspect figure.scn --set camera.roll=30deg --format json";

pub const PROBE_EXAMPLES: &str = "\
Examples:
  pinhole probe figure.scn 640 360               the middle of a picture of 1280 × 720 pixels
  pinhole probe figure.scn -10 0.5               left of the picture";

pub const DIFF_EXAMPLES: &str = "\
Examples:
  pinhole diff a.png b.exr                       two pictures
  pinhole diff mine.png figure.scn               a picture with what the scene means, without noise
  pinhole diff mine.png figure.scn -o where.png  also a heat map of the differences
  pinhole diff mine.png figure.scn --strict --format json
  pinhole diff old.scn new.scn -o where.png      what a change of a scene changes

Where B is a scene, the verdict comes first: the picture is right, right but for sampling noise, or wrong. Mistakes that explain \
the difference are named, with the --set arguments that make the scene give that picture; then what is right and what is not, \
object by object. A picture that carries a crop is compared with that part of the scene.

Differences are counted in steps of 8-bit sRGB: 1 is 1/255 of the way from black to white.

JSON: a, b, width, height (of A), size_b, rmse (in linear light, 0 to 1), largest {error, x, y, channel, \
a, b} (in steps), beyond {pixels, share}, undecided (so many pixels cannot be judged, as the exact picture's bound is too \
large there), tolerance (in steps), equal (whether no pixel is beyond it). Of two pictures of different sizes rmse, largest, beyond and \
undecided are null. With a scene also verdict (right, noise, wrong, or unknown: wrong, and not by a mistake known here), line (the \
verdict in words), samples_per_pixel (independent ones that make as much noise), mistakes [{id, message, help, set, explains}] \
(explains is the share of the squared difference beyond noise, 0 to 1; together they explain the picture), guesses (the same of an \
unknown verdict: what comes nearest), rest (the share that mistakes or guesses leave, if that is more than noise), objects [{index, \
name, right, off}] (off in pixels), limited (whether the search stopped at its limit before all mistakes were tried: --effort N \
multiplies that).

Exit status: 0 for pictures within the tolerance, and for one that is right, but for noise; 1 if not, or the scene has errors; \
2 trouble, also where a picture has another size than the scene's.";

pub const GRADE_EXAMPLES: &str = "\
Examples:
  pinhole grade figure.scn anna.png ben.png
  pinhole grade figure.scn handed_in/ -o graded  also writes graded/index.html with pictures, grade.csv and grade.jsonl
  pinhole grade figure.scn export.zip --picture 'render*.png' --points points.json
  pinhole grade figure.scn mine.png --format junit > report.xml
  pinhole grade figure.scn moodle.zip --format moodle --worksheet Grades.csv --points points.json > filled.csv

Each picture is compared with the scene's exact one, as diff does it, and each student has a line: the name, the root mean \
square of the differences in linear light, the samples in a pixel that make as much noise, and the verdict.

Of a folder or zip file each folder is a student, and each file beside these: Gradescope's exports, with the names in \
submission_metadata.yml, the clones of GitHub Classroom, and what Moodle hands out. Of several pictures of a student the \
newest is compared; of several of the same time, as in a clone, all are, and the best one counts. What is equal in every folder is the template, \
and does not count. Hidden files, __MACOSX and Thumbs.db are passed over. At most 10 000 entries of a zip file are read, \
unpacked to at most 256 MiB each and 4 GiB in all; archives in it, links and what is encrypted are not.

Points are a JSON file: {\"total\": 20, \"object\": 2, \"mistakes\": {\"roll_sign\": 3, \"*\": 2}}. A right picture gets the total; each \
mistake takes off what stands by its id, else, if it is about an object, that of object, once for each object, else that of *. A picture that is wrong \
for unknown reasons gets no points, and no zero either.

JSON, an object a line: what diff prints, with file in front; rendered_by_pinhole, whether the picture carries the \
text that Pinhole writes into its own; student; number, that of Moodle; pictures [{file, verdict, line}], if several were compared; \
not_compared, the other files; equal_to, other students whose picture is the same in every pixel; score; and error instead \
of a verdict where there is no picture that can be compared.

Exit status: 0 all are right, but for noise; 1 one is wrong, or a student has none that can be compared, or the scene has errors; 2 a PICTURE is \
missing, nothing could be compared, or other trouble.";

pub const REPORT_USAGE: &str = "\
pinhole report [OPTIONS] <SCENE>...
       pinhole report --numerics [--inputs <N>] [--threads <N>] [--format <FORMAT>]";

pub const REPORT_EXAMPLES: &str = "\
Renders the scenes by every method with more and more samples, several times and in mixed order, compares \
the pictures with the exact one, and tells which method comes to an error in the least CPU time. How many samples and \
runs there are follows from the time that --budget gives, unless --samples and --runs say it.

Examples:
  pinhole report figure.scn
  pinhole report figure.scn -o speed             writes speed/index.html, charts, CSV and JSON
  pinhole report figure.scn --set image.width=640 --set image.height=360 --methods sobol,halton,exact
  pinhole report figure.scn --samples 1,2,4,8,16 --runs 5 --error 1/256 --error 0.001
  pinhole report --numerics
  pinhole report --numerics --inputs 1000000     the full count: half an hour of a processor

In CSV and JSON, times are CPU times in seconds, unless they are called wall; errors (rmse) are in linear light.";

pub const SHEET_EXAMPLES: &str = "\
Examples:
  pinhole sheet *.scn -o sheet.png               all scenes of a folder
  pinhole sheet figure.scn -o roll.png --sweep camera.roll=0deg..90deg/10
  pinhole sheet figure.scn -o methods.png --set sampler.per_pixel=4 --columns 3

Each picture is rendered anew at its size on the sheet, with as many samples in a pixel as the scene asks for; of \
PNGs that carry a crop, too, the whole is shown. Under it stands the \
name of its file, or what a sweep has come to. If a scene has errors, there is no sheet.";

pub const FIGURE_EXAMPLES: &str = "\
Examples:
  pinhole figure camera figure.scn -o camera.svg
  pinhole figure pixel figure.scn --pixel 640,300 --set sampler.method=jittered -o pixel.svg
  pinhole figure triangle figure.scn --object Sail --set Sail.spin=30deg -o triangle.svg
  pinhole figure roll figure.scn --set camera.roll=20deg > roll.svg
  pinhole figure methods figure.scn --set sampler.per_pixel=16 -o methods.svg

A figure is drawn for a width of 12 cm, is light or dark as the page is, and describes itself to screen readers. The same \
scene gives the same bytes on every machine.";

pub const LESSON_EXAMPLES: &str = "\
Examples:
  pinhole lesson check examples/lessons/2-d-and-the-angle.md mine.scn
  pinhole lesson check lesson.md mine.scn --format json

A lesson is Markdown. Its conditions stand in fenced blocks `check`, one a line; all of them must hold.

JSON: lesson, scene, holds, conditions [{line, condition, words (the comment behind it), found (the value, or null if there is \
none), start (that of the lesson's own scene, if the condition names it), holds}].

Exit status: 0 all conditions hold; 1 one does not, or the scene has errors; 2 the lesson or its own scene has errors, or other \
trouble.";

pub const EXPLAIN_EXAMPLES: &str = "\
Examples:
  pinhole explain bare_angle
  pinhole explain camera                         a block, a field, a method, a function
  pinhole explain language                       the whole reference
  pinhole explain                                all codes, by subject
  pinhole explain up_parallel | less             as Markdown";

pub const FMT_EXAMPLES: &str = "\
Replaces each file by its canonical layout, whole or not at all, and does not touch it where nothing would change. \
Tokens, comments, and blank lines between groups stay; of line ends it matters whether a block stands on one line. A \
file with errors of syntax is left as it is.

Examples:
  pinhole fmt figure.scn
  pinhole fmt *.scn --check                      writes nothing, prints a diff of what would change
  pinhole fmt - < figure.scn > tidy.scn          from standard input to standard output

Exit status: 0 done; 1 a file has errors of syntax, or --check would change something; 2 trouble.";

#[cfg(feature = "lsp")]
pub const LSP_HELP: &str = "\
Editors start it themselves; grammar/editors/ has what they need for that.

Exit status: 0 after shutdown and exit; 1 if the editor left without; 2 trouble.";

#[cfg(feature = "studio")]
pub const STUDIO_EXAMPLES: &str = "\
Examples:
  pinhole studio figure.scn                      opens a browser
  pinhole studio                                 a new scene; Save asks for a name in the current folder
  pinhole studio figure.scn --no-open --port 8000
  pinhole studio --lesson lesson.md              a lesson, with its scene lesson.scn
  pinhole studio mine.scn --lesson lesson.md     a lesson, with the scene of a student

Serves this machine alone, and a browser that was given the printed address; no file but the scene and the lesson is read, and none but the scene written. \
Ctrl-C ends it, with status 130.";

pub const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  pinhole completions bash > ~/.local/share/bash-completion/completions/pinhole
  pinhole completions fish > ~/.config/fish/completions/pinhole.fish";

pub const MAN_EXAMPLES: &str = "\
Examples:
  pinhole man > pinhole.1
  pinhole man | man -l -";
