"""The commands that `work.py` counts and `against.py` times: whole processes, as users start
them."""

import json
import os
import pathlib
import random
import subprocess
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"
FIGURE = EXAMPLES / "figure_9_9.scn"

# Overrides for an exact picture of figure 9.9. The scene has no far plane, so the squares of the
# floor become ever smaller towards the horizon.
TO_THE_HORIZON = ["sampler.method=exact", "camera.fov=40deg"]

# Width and height of the pictures that `diff` and `grade` judge, in pixels.
SMALL = (96, 54)


@dataclass
class Command:
    """A command line of `pinhole`: a name, the arguments, the file for standard input, and the
    expected exit status."""

    name: str
    arguments: list
    stdin: pathlib.Path = pathlib.Path(os.devnull)
    status: int = 0


def sized(width, height, *sets):
    """Returns the arguments that set a picture's size, and further overrides."""
    values = [f"image.width={width}", f"image.height={height}", *sets]
    return [word for value in values for word in ("--set", value)]


def spheres(count):
    """Returns a scene of spheres at random depths from 5 to 50. The areas of their images add up to
    one and a half times the picture."""
    chance = random.Random(count)
    colors = ["olive", "teal", "orange", "gray", "#fa0", "#3366cc", "rgb(255, 165, 0)", "steelblue"]
    lines = ["image { width 1280  height 720 }", "camera { eye (0, 0, 0)  direction (0, 0, -1)  d 1 }"]
    lines.append("sampler { method jittered  per_pixel 4  seed 1 }")
    # At distance 1 from the eye, the visible window is 2 high and 2 · 16/9 wide. With this radius,
    # `count` spheres at distance 1 cover 1.5 times the area of the window, overlaps included.
    radius = (1.5 * 4 * 16 / 9 / (3.14159 * count)) ** 0.5
    for index in range(count):
        depth = chance.uniform(5, 50)
        x, y = chance.uniform(-1.78, 1.78) * depth, chance.uniform(-1, 1) * depth
        center = f"({x:.6f}, {y:.6f}, {-depth:.6f})"
        lines.append(f"sphere S{index} {{ center {center}  radius {radius * depth:.6f}  color {colors[index % 8]} }}")
    return "\n".join(lines) + "\n"


def messages():
    """Yields the messages of an editor in a short session. A letter is typed and deleted again and
    again. After each change, the editor sends its usual requests."""
    uri = "file:///figure.scn"
    text = FIGURE.read_text()
    line, column = 15, text.splitlines()[15].index("radius")
    document = {"uri": uri}
    position = {"line": line, "character": column + 3}
    yield "initialize", {"capabilities": {}}
    yield None, ("initialized", {})
    yield None, ("textDocument/didOpen", {"textDocument": {**document, "languageId": "scn", "version": 1, "text": text}})
    for version in range(2, 22):
        place = {"line": line, "character": column}
        edit = {"range": {"start": place, "end": place}, "text": "r"}
        if version % 2:
            edit = {"range": {"start": place, "end": {"line": line, "character": column + 1}}, "text": ""}
        change = {"textDocument": {**document, "version": version}, "contentChanges": [edit]}
        yield None, ("textDocument/didChange", change)
        for method in ["completion", "hover", "documentSymbol", "codeAction", "semanticTokens/full", "inlayHint", "formatting"]:
            span = {"start": {"line": 0, "character": 0}, "end": position}
            more = {"range": span, "context": {"diagnostics": []}, "options": {"tabSize": 2, "insertSpaces": True}}
            yield f"textDocument/{method}", {"textDocument": document, "position": position, **more}
    yield "shutdown", None
    yield None, ("exit", None)


def session():
    """Returns the messages as bytes, as the language server reads them."""
    out = b""
    for number, (method, content) in enumerate(messages()):
        message = {"jsonrpc": "2.0", "id": number, "method": method, "params": content}
        if method is None:
            message = {"jsonrpc": "2.0", "method": content[0], "params": content[1]}
        body = json.dumps({key: value for key, value in message.items() if value is not None}).encode()
        out += b"Content-Length: %d\r\n\r\n%s" % (len(body), body)
    return out


def broken(text):
    """Returns a text with a mistake in every tenth line."""
    slips = [("radius", "radus"), ("color", "colour"), ("sphere", "shpere"), (" }", ""), (", ", " , , ")]
    lines = text.splitlines(keepends=True)
    for index in range(9, len(lines), 10):
        lines[index] = lines[index].replace(*slips[index // 10 % len(slips)])
    return "".join(lines)


def prepare(folder, program, counts):
    """Writes the scenes and pictures that the commands read into a folder. `program` renders the
    pictures."""
    for count in counts:
        (folder / f"{count}.scn").write_text(spheres(count))
    (folder / "broken.scn").write_text(broken(spheres(1000)))
    (folder / "session").write_bytes(session())
    numbers = " ".join(str(number * 7 % 256) for number in range(3 * 320)) + "\n"
    (folder / "plain.ppm").write_text("P3\n320 180\n255\n" + 180 * numbers)
    for name, sets in [("right", ["sampler.method=regular"]), ("wrong", ["sampler.method=regular", "camera.roll=-9deg"])]:
        arguments = ["render", FIGURE, "-o", folder / f"{name}.png", *sized(*SMALL, *sets)]
        subprocess.run([program, *arguments], check=True, stdin=subprocess.DEVNULL)


def commands(folder, width, height, counts):
    """Yields all commands, with pictures of this size. `folder` has been prepared by `prepare`. The
    commands write their files into it."""
    picture, exr = folder / "picture.png", folder / "picture.exr"
    def render(name, scene, *sets, size=(width, height), out=picture, more=()):
        return Command(name, ["render", scene, "-o", out, *sized(*size, *sets), *more])

    for scene in sorted(EXAMPLES.glob("*.scn")):
        yield render(f"exact {scene.stem}", scene, "sampler.method=exact")
    yield render("exact to the horizon", FIGURE, *TO_THE_HORIZON)
    for method in "regular random jittered n_rooks multi_jittered hammersley halton sobol scatter".split():
        yield render(f"figure {method} 16", FIGURE, f"sampler.method={method}")
    yield render("figure sobol 64", FIGURE, "sampler.method=sobol", "sampler.per_pixel=64")
    yield render("figure EXR", FIGURE, out=exr)
    yield render("figure crop", FIGURE, more=["--crop", f"{width // 4},{height // 4},{width // 2},{height // 2}"])
    yield render("figure 1x1", FIGURE, size=(1, 1))
    # These pictures are so high that they are rendered in several bands. Their peak memory must not
    # grow with their height.
    yield render("poster", FIGURE, "sampler.per_pixel=1", size=(2048, 8192))
    yield render("poster EXR", FIGURE, "sampler.per_pixel=1", size=(2048, 4096), out=exr)
    for count in counts:
        scene = folder / f"{count}.scn"
        yield render(f"{count} spheres", scene)
        if count == counts[0]:
            yield render(f"{count} spheres exact", scene, "sampler.method=exact")
        yield render(f"{count} spheres 1x1", scene, size=(1, 1))
        yield Command(f"check {count} spheres", ["check", scene])
    yield Command("check tour", ["check", EXAMPLES / "language_tour.scn"])
    yield Command("check broken", ["check", folder / "broken.scn"], status=1)
    yield Command("check broken JSON", ["check", "--format", "json", folder / "broken.scn"], status=1)
    yield Command("fmt", ["fmt", "-"], stdin=folder / f"{counts[0]}.scn")
    yield Command("fmt --check", ["fmt", "--check", folder / f"{counts[0]}.scn"], status=1)
    small = sized(*SMALL)
    yield Command("diff right", ["diff", folder / "right.png", FIGURE, *small])
    yield Command("diff wrong", ["diff", folder / "wrong.png", FIGURE, *small], status=1)
    yield Command("diff JPEG", ["diff", ROOT / "benches" / "figure_9_9.jpg", FIGURE, *small])
    yield Command("diff pictures", ["diff", folder / "right.png", folder / "wrong.png"], status=1)
    yield Command("diff plain PPM", ["diff", folder / "plain.ppm", folder / "plain.ppm"])
    yield Command("grade", ["grade", FIGURE, folder / "right.png", *small])
    yield Command("editor session", ["lsp"], stdin=folder / "session")
    yield Command("probe", ["probe", FIGURE, "640.5", "360.5"])
    yield Command("inspect", ["inspect", FIGURE])
    yield Command("explain", ["explain", "language"])
    yield Command("help", ["--help"])
