"""Tests of the program that the wheel installs."""

from __future__ import annotations

import signal
import subprocess
import sys
import sysconfig
import time
from importlib import metadata
from pathlib import Path

from conftest import ENDLESS, Program


def test_exit_statuses_are_those_of_the_program(program: Program, tmp_path: Path) -> None:
    (tmp_path / "bad.scn").write_text("sphere { radius -1 }")
    assert program("--version").stdout.startswith(b"pinhole ")
    assert program("check", "a.scn").returncode == 0
    assert program("check", "bad.scn").returncode == 1
    assert program("render").returncode == 2
    unknown = program("\x1b[31m")
    assert unknown.returncode == 2 and b"\x1b" not in unknown.stderr and b"u{1b}" in unknown.stderr


def test_it_comes_with_its_licences() -> None:
    files = metadata.files("pinhole-scn") or []
    licences = {file.name: file.read_text() for file in files if file.name.startswith("LICENSE")}
    assert set(licences) == {"LICENSE-APACHE", "LICENSE-MIT"}
    assert "Permission is hereby granted" in licences["LICENSE-MIT"]


def test_it_runs_as_a_module(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pinhole"]
    said = subprocess.run([*command, "--help"], capture_output=True, text=True, check=True)
    assert "Usage: pinhole <COMMAND>" in said.stdout
    subprocess.run([*command, "new", "a.scn"], cwd=tmp_path, check=True)
    assert (tmp_path / "a.scn").read_text().startswith("camera {")


def test_it_starts_without_numpy_and_what_it_does_not_use() -> None:
    script = """
import sys, pinhole.__main__
sys.argv[1:] = ["--version"]
pinhole.__main__.main()
print([name for name in ("numpy", "json", "pinhole._scene") if name in sys.modules])
import pinhole
print(pinhole.Scene.__name__, pinhole.Fix.__name__, all(hasattr(pinhole, it) for it in pinhole.__all__))
"""
    said = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert said.stdout.splitlines()[1:] == ["[]", "Scene Fix True"]


def test_ctrl_c_during_the_import_prints_no_traceback() -> None:
    # The compiled module takes longest to import. Its import is where this script presses Ctrl-C.
    script = """
import os, signal, sys, pinhole.__main__
class Pressed:
    def find_spec(self, name, path=None, target=None):
        if name == "pinhole._native":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Pressed())
sys.argv[1:] = ["--version"]
sys.exit(pinhole.__main__.main())
"""
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert (said.returncode, said.stdout, said.stderr) == (-signal.SIGINT, b"", b"")


def test_ctrl_c_and_termination_leave_no_file(program: Program, tmp_path: Path) -> None:
    path = Path(sysconfig.get_path("scripts")) / "pinhole"
    sets = [f"--set={name}={value}" for name, value in ENDLESS.items()]
    for number in (signal.SIGINT, signal.SIGTERM):
        render = subprocess.Popen([path, "render", "a.scn", "-o", "a.png", *sets], cwd=tmp_path)
        try:
            time.sleep(1)
            assert render.poll() is None
            render.send_signal(number)
            assert render.wait(timeout=10) == 130
        finally:
            render.kill()
    assert [path.name for path in tmp_path.iterdir()] == ["a.scn"]


def test_ctrl_c_ends_a_command_that_waits(program: Program) -> None:
    path = Path(sysconfig.get_path("scripts")) / "pinhole"
    with subprocess.Popen([path, "check", "-"], stdin=subprocess.PIPE) as check:
        time.sleep(1)
        check.send_signal(signal.SIGINT)
        assert check.wait(timeout=10) == 130
