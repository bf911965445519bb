#!/usr/bin/env python3
"""Counts what commands cost, comparably from day to day: work.py PROGRAM [--write]

PROGRAM is a release build of `pinhole`. Every command of `commands.py` runs under valgrind, which
counts its instructions whatever else the machine does, and without it for its peak memory. Both are
compared with `work.csv`: the exit status is 1 if a command takes 3 % more instructions or 10 % more
memory than its row there, or has no row; a command that takes 3 % less is marked. A row counts for
the versions of rustc and valgrind in it; under others it is printed and not enforced. `--write`
writes `work.csv` anew."""

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
# Maximum ratios of a command's instructions and peak memory to those in its row of `work.csv`;
# above them, the command fails. Instruction counts repeat within 0.2 %. Peak memory repeats only
# within 5 %, so the least of MEMORY_RUNS runs counts.
MORE_INSTRUCTIONS, MORE_MEMORY = 1.03, 1.10
MEMORY_RUNS = 5
ENVIRONMENT = {**os.environ, "NO_COLOR": "1"}
# Processors that run no command at the moment. Each command has one processor for itself, so that
# it starts the same number of threads on every machine.
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
    # GNU time starts the command from a small process: started from here, the command's peak would
    # include Python's own memory.
    with tempfile.NamedTemporaryFile("r") as report:
        run(command, ["/usr/bin/time", "--quiet", "-f", "%M", "-o", report.name, *line])
        return int(report.read())


def version(program):
    return re.search(r"\d+\.\d+\.\d+", subprocess.run([program, "--version"], capture_output=True, text=True).stdout)[0]


def measure_all(program):
    """Returns a row for each command, in order; measures one command per processor at a time."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(PROCESSORS.qsize()) as pool:
        folder = pathlib.Path(folder)
        commands.prepare(folder, program, SPHERES)
        versions = [version("rustc"), version("valgrind")]

        def row(command):
            return [command.name, *measure(program, command), *versions]

        return list(pool.map(row, commands.commands(folder, *SIZE, SPHERES)))


def compare(rows):
    """Prints each row beside the committed one; returns the names of the commands that take too
    much."""
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
