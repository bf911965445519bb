"""Tests of the example of a cluster. A script that replaces `sbatch` runs its commands."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import sysconfig
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import ENDLESS, TEXT
from distributed import LocalCluster

FOLDER = Path(__file__).parent.parent.parent / "examples" / "cluster"

SBATCH = """\
#!/usr/bin/env bash
# Runs the tasks of `sbatch --array=1-N SCRIPT ARGUMENT...` one after another.
set -u
[[ $1 =~ ^--array=1-([0-9]+)$ ]] || exit 2
shift
for task in $(seq "${BASH_REMATCH[1]}"); do
  SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_PER_TASK=2 bash "$@"
done
"""

Shell = Callable[[str], "subprocess.Popen[str]"]


@pytest.fixture
def shell(tmp_path: Path) -> Shell:
    """Starts a command in a folder with the example's files and a scene."""
    for name in ("render.sh", "poster.py"):
        (tmp_path / name).write_bytes((FOLDER / name).read_bytes())
        (tmp_path / name).chmod(0o755)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "sbatch").write_text(SBATCH)
    (tmp_path / "bin" / "sbatch").chmod(0o755)
    (tmp_path / "poster.scn").write_text(TEXT)
    path = f"{tmp_path / 'bin'}:{sysconfig.get_path('scripts')}:{os.environ['PATH']}"

    def start(command: str) -> subprocess.Popen[str]:
        # A new session, so that a job can be killed with all of its processes, as by Slurm.
        return subprocess.Popen(
            ["bash", "-c", command],
            cwd=tmp_path,
            env={**os.environ, "PATH": path},
            start_new_session=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    return start


def output_of(process: subprocess.Popen[str], status: int = 0) -> str:
    output, _ = process.communicate(timeout=120)
    assert process.returncode == status, output
    return output


def command(start: str) -> str:
    """Returns the shell block of the example's README that begins with this text."""
    blocks = re.findall(r"```sh\n(.*?)```", (FOLDER / "README.md").read_text(), re.DOTALL)
    (block,) = (block for block in blocks if block.startswith(start))
    return str(block)


def test_the_commands_of_the_page_make_the_picture(shell: Shell, tmp_path: Path) -> None:
    small = command("sbatch").replace("=4096", "=90")
    assert small.count("=90") == 2
    assert output_of(shell(small)).count("is rendered\n") == 8
    output_of(shell(command("pinhole merge")))
    sets = "--set image.width=90 --set image.height=90"
    output_of(shell(f"pinhole render poster.scn -o one.png {sets}"))
    assert (tmp_path / "poster.png").read_bytes() == (tmp_path / "one.png").read_bytes()


def test_a_task_that_was_killed_is_run_again(shell: Shell, tmp_path: Path) -> None:
    loop = command("for task")
    slow = " ".join(f"--set {name}={value}" for name, value in ENDLESS.items())
    task = shell(f"SLURM_ARRAY_TASK_ID=3 ./render.sh poster.scn 8 bands {slow}")
    time.sleep(2)
    status = task.poll()
    os.killpg(task.pid, signal.SIGKILL)
    assert status is None
    output_of(task, -signal.SIGKILL)
    assert list((tmp_path / "bands").iterdir()) == []

    output_of(shell(loop.replace("3 4", "4")))
    gap = output_of(shell(command("pinhole merge")), 2)
    assert "no part has the pixels 0,16,96,8" in gap
    again = output_of(shell(loop))
    assert again.count("is there already\n") == 7 and again.count("is rendered\n") == 1
    output_of(shell(command("pinhole merge")))
    output_of(shell("pinhole render poster.scn -o one.png"))
    assert (tmp_path / "poster.png").read_bytes() == (tmp_path / "one.png").read_bytes()


def test_a_task_without_its_number_is_refused(shell: Shell) -> None:
    usage = "usage: sbatch --array=1-N render.sh SCENE N FOLDER"
    assert usage in output_of(shell("./render.sh poster.scn 8 bands"), 2)
    assert usage in output_of(shell("SLURM_ARRAY_TASK_ID=1 ./render.sh poster.scn"), 2)


def test_the_script_for_dask_makes_the_picture(shell: Shell, tmp_path: Path) -> None:
    line = command("python").replace("python", sys.executable, 1)
    with LocalCluster(n_workers=1, dashboard_address=None) as cluster:
        output_of(shell(line.replace("tcp://scheduler:8786", cluster.scheduler_address)))
    output_of(shell("pinhole render poster.scn -o one.png"))
    assert (tmp_path / "poster.png").read_bytes() == (tmp_path / "one.png").read_bytes()


def test_shellcheck_finds_nothing() -> None:
    shellcheck = Path(sysconfig.get_path("scripts")) / "shellcheck"
    said = subprocess.run([shellcheck, FOLDER / "render.sh"], capture_output=True, text=True)
    assert (said.stdout, said.returncode) == ("", 0)
