#!/usr/bin/env python3
"""CPU seconds, wall time and peak memory of whole processes, in turns: text.py ROUNDS SCENE PROGRAM...

Each PROGRAM is a `pinhole` binary; it renders the scene as a picture of one pixel with one sample, so that nearly all of its time
goes from the text to the tracer's world. Of each number the least is printed, and of the CPU seconds the median as well."""

import os
import subprocess
import sys
import tempfile
import time

SETS = ["image.width=1", "image.height=1", "sampler.method=regular", "sampler.per_pixel=1"]


def run(program, scene, picture):
    arguments = [program, "render", scene, "-o", picture]
    for value in SETS:
        arguments += ["--set", value]
    start = time.monotonic()
    process = subprocess.Popen(arguments, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{program} failed on {scene}")
    return usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    rounds, scene, programs = int(sys.argv[1]), sys.argv[2], sys.argv[3:]
    results = {program: [] for program in programs}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for program in programs:
                results[program].append(run(program, scene, os.path.join(folder, "picture.png")))
    for program, numbers in results.items():
        cpu, wall, memory = (sorted(column) for column in zip(*numbers))
        print(
            f"{scene} {program}: {cpu[0]:.3f} CPU seconds (median {cpu[len(cpu) // 2]:.3f}), "
            f"{wall[0]:.3f} s, {memory[0]:.0f} MB"
        )


main()
