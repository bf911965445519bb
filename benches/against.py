#!/usr/bin/env python3
"""Times commands of two versions of Pinhole, in turns: against.py PROGRAM COMMIT [NAME...]

PROGRAM is a release build of `pinhole`. COMMIT is a commit, which is built in its own folder under
`target/against`, or the path of another program. With a NAME, only the commands of `commands.py`
whose names contain it are run. Each command runs nine times with each program, in turns. The
shortest time is used, since other work on the machine only makes a time longer.

Prints the CPU seconds (user and system time of all threads) and the wall time of COMMIT's program,
and the ratios of PROGRAM's times to them. The last column compares two series of PROGRAM itself:
the distance of this ratio from 1 shows how exact the other ratios are."""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import commands

ROUNDS = 9
SIZE = (1280, 720)
SPHERES = [10_000, 100_000, 1_000_000]


def build(commit):
    """Builds a commit in a clone of the repository. Returns the path of the release program."""
    if os.path.isfile(commit):
        return commit
    commit = subprocess.check_output(["git", "-C", commands.ROOT, "rev-parse", "--short", commit], text=True).strip()
    folder = commands.ROOT / "target" / "against" / commit
    if not folder.exists():
        subprocess.run(["git", "clone", "--quiet", commands.ROOT, folder], check=True)
        subprocess.run(["git", "-C", folder, "checkout", "--quiet", commit], check=True)
    environment = {name: value for name, value in os.environ.items() if name != "CARGO_TARGET_DIR"}
    subprocess.run(["cargo", "build", "--release", "--locked"], cwd=folder, check=True, env=environment)
    return folder / "target" / "release" / "pinhole"


def run(program, command):
    """Returns CPU and wall seconds. If the exit status is unexpected, returns infinite times:
    an older program may not know the command."""
    start = time.monotonic()
    with open(command.stdin, "rb") as stdin:
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        process = subprocess.Popen([program, *command.arguments], stdin=stdin, **quiet)
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != command.status:
        return math.inf, math.inf
    return usage.ru_utime + usage.ru_stime, time.monotonic() - start


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, other, names = sys.argv[1], build(sys.argv[2]), sys.argv[3:]
    print(f"{'':36}{'CPU s':>9}{'wall s':>9}{'CPU':>9}{'wall':>9}{'itself':>9}")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        commands.prepare(folder, program, SPHERES)
        for command in commands.commands(folder, *SIZE, SPHERES):
            if names and not any(name in command.name for name in names):
                continue
            series = [[], [], []]
            for _ in range(ROUNDS):
                for runs, binary in zip(series, [other, program, program]):
                    runs.append(run(binary, command))
            (cpu, wall), (new_cpu, new_wall), (again, _) = ([min(column) for column in zip(*runs)] for runs in series)
            ratios = [new_cpu / cpu, new_wall / wall, again / new_cpu]
            print(f"{command.name:36}{cpu:9.4f}{wall:9.4f}" + "".join(f"{ratio:9.3f}" for ratio in ratios), flush=True)


if __name__ == "__main__":
    main()
