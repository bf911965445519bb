"""Fixtures that all tests share: a scene, and the installed program."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pinhole
import pytest

TEXT = """\
// A ball and a sail on a checkered floor.
let h = 1
image    { width 96  height 64 }
camera   { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  d 2.75 }
sampler  { method sobol  per_pixel 16 }
sphere   Ball { center (-1.6, h, 0)  color olive }
triangle Sail { centroid (0.2, 1, 0.6)  normal (0.3, 0, 1)  sides (2, 2, 1)  color teal }
checkerboard  { colors (gray, white) }
"""

ENDLESS = {"sampler.method": "random", "sampler.per_pixel": 2**40}
"""Settings of a picture that no machine finishes during a test."""

LONG_PIXEL = """\
image { width 1  height 1 } camera { eye (0, 0, 100)  direction (0, 0, -1)  d 1 }
sampler { method exact }
""" + "".join(f"sphere {{ center (0, 0, {i}e-9)  radius 20 }}\n" for i in range(150))
"""A scene of one pixel, whose exact mean takes more than a minute."""

# A job in the background ignores Ctrl-C, and the processes that it starts inherit this. The tests
# interrupt such processes, so Ctrl-C is handled here in the usual way.
signal.signal(signal.SIGINT, signal.default_int_handler)

Program = Callable[..., "subprocess.CompletedProcess[bytes]"]


@pytest.fixture
def scene() -> pinhole.Scene:
    return pinhole.Scene(TEXT, name="a.scn")


@pytest.fixture
def program(tmp_path: Path) -> Program:
    """Runs the program that the wheel installs, in a folder with the scene as `a.scn`."""
    (tmp_path / "a.scn").write_text(TEXT)
    path = Path(sysconfig.get_path("scripts")) / "pinhole"

    def run(*arguments: str) -> subprocess.CompletedProcess[bytes]:
        return subprocess.run(
            [path, *arguments], cwd=tmp_path, capture_output=True, timeout=60, check=False
        )

    return run


@pytest.fixture
def answer(program: Program) -> Callable[..., dict[str, Any]]:
    """Returns what the program answers as JSON."""

    def ask(*arguments: str) -> dict[str, Any]:
        said = program(arguments[0], "--format", "json", *arguments[1:])
        assert said.returncode in (0, 1), said.stderr
        facts: dict[str, Any] = json.loads(said.stdout)
        return facts

    return ask


@pytest.fixture
def python(tmp_path: Path) -> Iterator[Callable[[str], "subprocess.Popen[str]"]]:
    """Starts Python on a script, which can read the scene's text as `TEXT`. A script that still
    runs at the end of the test is killed."""
    started = []

    def start(script: str) -> subprocess.Popen[str]:
        path = tmp_path / "script.py"
        path.write_text(f"TEXT = {TEXT!r}\n{script}")
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(
            [sys.executable, path], cwd=tmp_path, env=environment, stdout=subprocess.PIPE, text=True
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()
