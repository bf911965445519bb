#!/usr/bin/env python3
"""Measures the instructions and the memory of commands: work.py PROGRAM [--write]

PROGRAM is a release build of `pinhole`. Every command of `commands.py` runs under valgrind, which
counts its instructions; other work on the machine does not affect the count. The command also runs
without valgrind, for its peak memory.

The results are compared with the rows of `work.csv`. The exit status is 1 if a command needs 3 %
more instructions or 10 % more memory than in its row, or if there is no row for it. A command that
needs 3 % fewer instructions is marked. A row names versions of rustc and valgrind; with other
versions, the comparison is printed but does not affect the exit status. `--write` replaces
`work.csv` by the results."""

import csv
import os
import pathlib
import queue
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import commands

TABLE = pathlib.Path(__file__).with_suffix(".csv")
COLUMNS = ["command", "instructions", "memory_kb", "rustc", "valgrind"]
SIZE = (160, 90)
SPHERES = [1000, 10_000]
# Maximum ratios of a command's instructions and peak memory to those in its row of `work.csv`.
# Above them, the comparison fails. In repeated runs, instruction counts differ by up to 0.2 %. Peak
# memory differs by up to 5 %, so the smallest value of MEMORY_RUNS runs is used.
MORE_INSTRUCTIONS, MORE_MEMORY = 1.03, 1.10
MEMORY_RUNS = 5
ENVIRONMENT = {**os.environ, "NO_COLOR": "1"}
# Processors that run no command at the moment. Each command runs on one processor, so that it
# starts the same number of threads on every machine.
PROCESSORS = queue.SimpleQueue()
for processor in os.sched_getaffinity(0):
    PROCESSORS.put(processor)


def run(command, line):
    """Runs a command line on one processor and returns what it wrote to standard error."""
    processor = PROCESSORS.get()
    try:
        line = ["taskset", "--cpu-list", str(processor), *line]
        with open(command.stdin, "rb") as stdin:
            done = subprocess.run(line, stdin=stdin, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=ENVIRONMENT)
    finally:
        PROCESSORS.put(processor)
    said = done.stderr.decode(errors="replace")
    if done.returncode != command.status:
        sys.exit(f"{command.name}: status {done.returncode}, not {command.status}\n{said[-2000:]}")
    return said


def measure(program, command):
    """Returns the instructions of a command and its peak resident memory in kilobytes."""
    line = [program, *command.arguments]
    said = run(command, ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *line])
    instructions = int(re.search(r"Collected : (\d+)", said)[1])
    return instructions, min(peak(command, line) for _ in range(MEMORY_RUNS))


def peak(command, line):
    """Returns the peak resident memory of a command in kilobytes."""
    # GNU time is a small process that starts the command. If Python started the command itself, the
    # peak would include Python's memory.
    with tempfile.NamedTemporaryFile("r") as report:
        run(command, ["/usr/bin/time", "--quiet", "-f", "%M", "-o", report.name, *line])
        return int(report.read())


def version(program):
    return re.search(r"\d+\.\d+\.\d+", subprocess.run([program, "--version"], capture_output=True, text=True).stdout)[0]


def measure_all(program):
    """Returns a row for each command, in order. Each processor measures one command at a time."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(PROCESSORS.qsize()) as pool:
        folder = pathlib.Path(folder)
        commands.prepare(folder, program, SPHERES)
        versions = [version("rustc"), version("valgrind")]

        def row(command):
            return [command.name, *measure(program, command), *versions]

        return list(pool.map(row, commands.commands(folder, *SIZE, SPHERES)))


def compare(rows):
    """Prints each row with its ratios to the row in `work.csv`. Returns the commands that need too
    much, with the reasons."""
    with open(TABLE, newline="") as file:
        known = {row["command"]: row for row in csv.DictReader(file)}
    failed = [f"{name} (is no command any more)" for name in known.keys() - {row[0] for row in rows}]
    for name, instructions, memory, *versions in rows:
        before = known.get(name)
        if before is None:
            failed.append(f"{name} (has no row)")
            continue
        work, space = instructions / int(before["instructions"]), memory / int(before["memory_kb"])
        applies = versions == [before["rustc"], before["valgrind"]]
        verdict = ""
        if work > MORE_INSTRUCTIONS or space > MORE_MEMORY:
            verdict = "more" if applies else "more, with other versions"
            if applies:
                failed.append(f"{name} ({work:.3f} of the instructions, {space:.2f} of the memory)")
        elif work < 2 - MORE_INSTRUCTIONS:
            verdict = "less: its row can fall"
        print(f"{name:36}{instructions / 1e6:12.2f} M {work:7.3f}{memory / 1024:9.1f} MB {space:6.2f}  {verdict}")
    return failed


def main():
    if len(sys.argv) not in [2, 3] or sys.argv[2:] not in [[], ["--write"]]:
        sys.exit(__doc__)
    rows = measure_all(sys.argv[1])
    if sys.argv[2:]:
        with open(TABLE, "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
        return
    failed = compare(rows)
    if failed:
        sys.exit("\nToo much work: " + "; ".join(failed))


if __name__ == "__main__":
    main()
