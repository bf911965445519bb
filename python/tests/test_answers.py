"""Tests that problems and answers about a scene are those that the program prints as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pinhole
import pytest
from conftest import TEXT, Program

Answer = Callable[..., dict[str, Any]]

BAD = """\
camera { eye (0, 2, 8)  lookt (0, 1, 0) }
sphere Bäll { center (0, 1, 0)  radius -1 }  checkerboard { color (red, white) }
"""


def test_probe_and_inspect_say_what_the_program_says(scene: pinhole.Scene, answer: Answer) -> None:
    assert scene.inspect() == answer("inspect", "a.scn")
    for x, y in [(48.5, 32.25), (20, 30), (-5, 1000)]:
        assert scene.probe(x, y) == answer("probe", "a.scn", "--", str(x), str(y))
    assert scene.probe(32, 30)["hits"][0]["object"] == "Ball"
    for x in (float("nan"), float("inf")):
        with pytest.raises(ValueError, match="not finite"):
            scene.probe(x, 0)


def wrong(**settings: pinhole.Value) -> np.ndarray:
    return pinhole.Scene(TEXT, {"camera.up": (0, -1, 0), **settings}).render()


def test_grade_says_what_the_program_says(
    scene: pinhole.Scene, answer: Answer, tmp_path: Path
) -> None:
    upside_down = pinhole.Scene(TEXT, set={"camera.up": (0, -1, 0)})
    for theirs, verdict in [(scene, "noise"), (upside_down, "wrong")]:
        theirs.save(tmp_path / "a.png")
        said = answer("diff", "a.png", "a.scn")
        ours = scene.grade(theirs.render())
        assert ours["verdict"] == verdict
        assert ours == {key: said[key] for key in said if key not in ("a", "b")}
    assert ours["mistakes"][0]["message"]


def test_grade_reads_arrays_as_files_of_these_numbers(
    scene: pinhole.Scene, answer: Answer, tmp_path: Path
) -> None:
    rolled = pinhole.Scene(TEXT, set={"camera.roll": "8deg"})
    rolled.save(tmp_path / "a.exr")
    floats = OpenEXR.File(str(tmp_path / "a.exr")).channels()["RGB"].pixels
    words = rolled.render().astype(np.uint16) * 257
    header = b"P6 96 64 65535\n"
    (tmp_path / "a.ppm").write_bytes(header + words.astype(">u2").tobytes())
    for name, array in [("a.exr", floats), ("a.ppm", words)]:
        said = answer("diff", name, "a.scn")
        ours = scene.grade(array)
        assert ours == {key: said[key] for key in said if key not in ("a", "b")}


def test_grade_reads_views_in_any_order_of_memory(scene: pinhole.Scene) -> None:
    picture = np.asfortranarray(scene.render()[::-1])
    assert scene.grade(picture[::-1])["verdict"] == "noise"
    assert scene.grade(picture)["verdict"] == "wrong"


def test_grade_of_a_part(scene: pinhole.Scene, answer: Answer, tmp_path: Path) -> None:
    crop = (10, 10, 60, 40)
    part = wrong()[10:50, 10:70]
    with pytest.raises(ValueError, match=r"\(40, 60, 3\), and the scene's is \(64, 96, 3\)"):
        scene.grade(part)
    (tmp_path / "a.ppm").write_bytes(b"P6 60 40 255\n" + part.tobytes())
    said = answer("diff", "a.ppm", "a.scn", "--crop", "10,10,60,40")
    ours = scene.grade(part, crop=crop)
    assert ours == {key: said[key] for key in said if key not in ("a", "b")}


def test_grade_refuses_what_is_no_picture(scene: pinhole.Scene) -> None:
    picture = scene.render()
    for array in (picture[..., :2], picture[..., 0], picture.astype(np.int64), [["a"]]):
        with pytest.raises(ValueError, match="picture"):
            scene.grade(array)  # type: ignore[arg-type]


def lines(problems: pinhole.Problems) -> list[dict[str, Any]]:
    """Returns problems in the form of the program's JSON, without the file's name."""

    def known(facts: Any) -> Any:
        if isinstance(facts, dict):
            return {k: known(v) for k, v in facts.items() if (k, v) != ("file", None)}
        return [known(fact) for fact in facts] if isinstance(facts, (list, tuple)) else facts

    return [known(asdict(problem)) for problem in problems]


def test_problems_are_those_of_the_program(program: Program, tmp_path: Path) -> None:
    (tmp_path / "bad.scn").write_text(BAD)
    sets = {"camera.roll": "8", "Nobody.radius": 1}
    options = [it for key, value in sets.items() for it in ("--set", f"{key}={value}")]
    said = program("check", "bad.scn", *options, "--format", "json")
    theirs = [json.loads(line) for line in said.stdout.splitlines()]
    assert {line.pop("file") for line in theirs} == {"bad.scn"}
    assert len(theirs) >= 5
    assert lines(pinhole.check(BAD, set=sets, name="bad.scn")) == theirs
    with pytest.raises(pinhole.SceneError) as caught:
        pinhole.load(tmp_path / "bad.scn", set=sets)
    assert lines(caught.value.problems) == theirs
    report = program("check", "bad.scn", *options).stderr.decode()
    assert str(caught.value).splitlines()[:5] == [
        line.replace(str(tmp_path / "bad.scn"), "bad.scn") for line in report.splitlines()[:5]
    ] or "bad.scn" in str(caught.value)


def test_a_problem_has_its_place_and_its_fix() -> None:
    with pytest.raises(ValueError, match="unknown_field") as caught:
        pinhole.Scene(BAD)
    assert isinstance(caught.value, pinhole.SceneError)
    first = caught.value.problems[0]
    assert (first.severity, first.code) == ("error", "pinhole::unknown_field")
    assert "lookt" in first.message and first.help
    label = first.labels[0]
    assert (label.line, label.column, label.length, label.file) == (1, 25, 5, None)
    fix = first.fixes[0]
    edit = fix.edits[0]
    text = BAD.encode()
    fixed = text[: edit.offset] + edit.text.encode() + text[edit.offset + edit.length :]
    assert b"lookat (0, 1, 0)" in fixed and fix.applicability == "safe"
    problems = pinhole.check(TEXT, set=["camera.roll=8"])
    assert [label.file for label in problems[0].labels] == ["--set #1"]


def test_warnings_raise_nothing(scene: pinhole.Scene) -> None:
    assert scene.problems == () and repr(scene.problems) == "no problems"
    empty = pinhole.Scene("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")
    assert [problem.severity for problem in empty.problems] == ["warning"]
    assert "the scene has no objects" in repr(empty.problems)


def test_text_that_is_not_utf_8_is_an_error_at_its_byte(tmp_path: Path) -> None:
    (tmp_path / "a.scn").write_bytes(TEXT.encode() + b"// caf\xe9\n")
    with pytest.raises(pinhole.SceneError) as caught:
        pinhole.load(tmp_path / "a.scn")
    assert caught.value.problems[0].labels[0].offset == len(TEXT) + len("// caf")


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"h": 2, "Ball.center": (0, 0.1, 1e-7)}, ("h=2", "Ball.center=(0, 0.1, 1e-07)")),
        ({"Ball.center": np.array([1.5, 2, 1 / 3])}, (f"Ball.center=(1.5, 2, {1 / 3!r})",)),
        (["h=2", "camera.roll=8deg"], ("h=2", "camera.roll=8deg")),
    ],
)
def test_settings_are_written_as_on_the_command_line(
    settings: pinhole.Settings, expected: tuple[str, ...]
) -> None:
    assert pinhole.Scene(TEXT, settings).set == expected


def test_settings_that_are_one_text_are_refused() -> None:
    with pytest.raises(TypeError, match="mapping"):
        pinhole.Scene(TEXT, "camera.roll=8deg")
