"""Tests of what notebooks show, of the cell magic, and of the notebooks in `python/notebooks`."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import pinhole
import pytest
from conftest import TEXT
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from nbclient import NotebookClient
from PIL import Image

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))


@pytest.fixture
def shell() -> Iterator[Any]:
    shell = InteractiveShell.instance()
    shell.run_line_magic("reload_ext", "pinhole")
    yield shell
    InteractiveShell.clear_instance()


def test_a_scene_is_shown_as_its_picture(scene: pinhole.Scene, tmp_path: Path) -> None:
    scene.save(tmp_path / "a.png")
    assert scene._repr_png_() == (tmp_path / "a.png").read_bytes()
    picture = np.asarray(Image.open(io.BytesIO(scene._repr_png_())))
    np.testing.assert_array_equal(picture, scene.render())
    assert repr(scene) == "<Scene 'a.scn', 96 × 64 pixels>"


def test_problems_are_shown_as_text_of_a_page() -> None:
    problems = pinhole.check('camera { lookat "<b>&" }', name="<script>.scn")
    page = problems._repr_html_()
    assert "&lt;script&gt;.scn" in page and "&lt;b&gt;&amp;" in page
    assert "<b>" not in page and "<script>" not in page


def test_the_cell_magic_names_a_scene_and_shows_it(shell: Any) -> None:
    cell = TEXT + "sphere Far { center (900, 0, 0) }\n"
    line = "%%scn ball --set camera.roll=8deg --set Ball.center='(0, 1, 0)'\n"
    with capture_output() as shown:
        done = shell.run_cell(line + cell)
    done.raise_error()
    ball = shell.user_ns["ball"]
    assert done.result is ball
    assert (ball.text, ball.set) == (cell, ("camera.roll=8deg", "Ball.center=(0, 1, 0)"))
    problems = [output.data for output in shown.outputs]
    assert [set(data) for data in problems] == [{"text/plain", "text/html"}]
    assert "outside of the picture" in problems[0]["text/plain"]
    shell.user_ns["ball"] = None
    assert set(shell.display_formatter.format(done.result)[0]) == {"text/plain", "image/png"}


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("%%scn", "the following arguments are required: name"),
        ("%%scn 3d", "3d is not the name of a variable"),
        ("%%scn a --sat h=1", "unrecognized arguments: --sat h=1"),
    ],
)
def test_a_wrong_line_of_the_magic_is_refused(shell: Any, line: str, message: str) -> None:
    with capture_output() as shown:
        done = shell.run_cell(f"{line}\n{TEXT}")
    assert not done.success and message in shown.stderr + shown.stdout


def test_errors_are_shown_as_a_report_instead_of_calls(shell: Any) -> None:
    out = io.StringIO()
    with redirect_stdout(out):
        done = shell.run_cell("%%scn ball\nsphere { radius -1 }")
    assert isinstance(done.error_in_exec, pinhole.SceneError)
    assert out.getvalue().strip() == str(done.error_in_exec)
    assert "pinhole::" in out.getvalue() and "Traceback" not in out.getvalue()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    resources = {"metadata": {"path": str(tmp_path)}}
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources=resources).execute()
    shown = [output for cell in code for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in shown)
    assert not [output for output in shown if output.get("name") == "stderr"]


def test_there_are_three_notebooks() -> None:
    assert len(NOTEBOOKS) == 3
