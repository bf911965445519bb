#!/usr/bin/env python3
"""Instructions, counted by valgrind's callgrind: instructions.py BENCH [NAME...]

BENCH is the built benchmark `culling` (`cargo bench --no-run` prints where it is). Printed are the millions of instructions of the
plain way, one by one, and culling's as a ratio to it, of figure 9.9 at 160 x 90 pixels with 64 samples each by the methods that are
named, or by all; start-up and the scene's preparation are counted with each."""

import re
import shutil
import subprocess
import sys

METHODS = "regular random jittered n_rooks multi_jittered hammersley halton sobol scatter".split()


def count(command):
    tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    run = subprocess.run(tool + command, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not found:
        sys.exit(f"{command}: {run.stderr}")
    return int(found[1])


def figure(bench, way, method):
    return count([bench, "--bench", "--once", way, method, "160", "64", "1"])


def table(names, ways, counted):
    width = max(map(len, names)) + 2
    print(" " * width + "".join(f"{way:>12}" for way in ways))
    for name in names:
        plain, *others = (counted(way, name) for way in ways)
        ratios = "".join(f"{other / plain:12.3f}" for other in others)
        print(f"{name:{width}}{plain / 1e6:12.1f}{ratios}", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not there: nothing is counted")
    bench, names = sys.argv[1], sys.argv[2:]
    ways = ["OneByOne", "Culled"]
    table(names or METHODS, ways, lambda way, name: figure(bench, way, name))


main()
