#!/usr/bin/env python3
"""Instructions of whole processes, counted by valgrind's callgrind: instructions.py BENCH [METHOD...]

BENCH is the built benchmark `culling` (`cargo bench --bench culling --no-run` prints where it is). It renders figure 9.9 at 160 x 90
pixels with 64 samples each, in each way and by each method. Printed are the millions of instructions of the plain way, one
by one, and the other ways' as ratios to it; start-up and the scene's preparation are counted with each."""

import re
import shutil
import subprocess
import sys

METHODS = "regular random jittered n_rooks multi_jittered hammersley halton sobol scatter".split()
WAYS = ["OneByOne", "Narrow", "Together", "Culled"]


def count(bench, way, method):
    picture = ["--bench", "--once", way, method, "160", "64", "1"]
    tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    run = subprocess.run(tool + [bench] + picture, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not found:
        sys.exit(f"{way} {method}: {run.stderr}")
    return int(found[1])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not there: nothing is counted")
    print(f"{'':16}" + "".join(f"{way:>12}" for way in WAYS))
    for method in sys.argv[2:] or METHODS:
        plain, *others = (count(sys.argv[1], way, method) for way in WAYS)
        ratios = "".join(f"{other / plain:12.3f}" for other in others)
        print(f"{method:16}{plain / 1e6:12.1f}{ratios}", flush=True)


main()
