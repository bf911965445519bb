#!/usr/bin/env python3
"""CPU seconds, wall time and peak memory of whole processes, in turns: processes.py ROUNDS figure|text SCENE PROGRAM...

Each PROGRAM is a `pinhole` binary. `figure` renders the scene at 1280 x 720 pixels by every method and in the sizes and with the
samples of the lists below, and writes a PNG each time. `text` renders it as a picture of one pixel with one sample, so that
nearly all of its time goes from the text to the tracer's world. Of each number the least is printed, and of the CPU seconds the
median as well."""

import os
import subprocess
import sys
import tempfile
import time

METHODS = "regular random jittered n_rooks multi_jittered hammersley halton sobol scatter".split()


def sampled(width, height, method, samples):
    sets = [f"image.width={width}", f"image.height={height}", f"sampler.method={method}"]
    if samples is not None:
        sets.append(f"sampler.per_pixel={samples}")
    return sets


def figures():
    """What is measured of the figure: a name, and what is set."""
    for method in METHODS:
        yield f"{method}, 64", sampled(1280, 720, method, 64)
    for method, samples in [("hammersley", 46), ("multi_jittered", 48), ("sobol", 48)]:
        yield f"{method}, {samples}", sampled(1280, 720, method, samples)
    yield "exact", sampled(1280, 720, "exact", None)
    yield "multi_jittered, 1", sampled(1280, 720, "multi_jittered", 1)
    yield "320 x 180, multi_jittered, 16", sampled(320, 180, "multi_jittered", 16)
    yield "1 x 1, multi_jittered, 1", sampled(1, 1, "multi_jittered", 1)


def run(program, scene, sets, picture):
    arguments = [program, "render", scene, "-o", picture]
    for value in sets:
        arguments += ["--set", value]
    start = time.monotonic()
    process = subprocess.Popen(arguments, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{program} failed on {scene}")
    return usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024


def main():
    if len(sys.argv) < 5 or sys.argv[2] not in ["figure", "text"]:
        sys.exit(__doc__)
    rounds, scene, programs = int(sys.argv[1]), sys.argv[3], sys.argv[4:]
    pictures = list(figures()) if sys.argv[2] == "figure" else [("text", sampled(1, 1, "regular", 1))]
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "picture.png")
        for name, sets in pictures:
            results = {program: [] for program in programs}
            for _ in range(rounds):
                for program in programs:
                    results[program].append(run(program, scene, sets, picture))
            for program, numbers in results.items():
                cpu, wall, memory = (sorted(column) for column in zip(*numbers))
                print(
                    f"{scene} {name} {program}: {cpu[0]:.3f} CPU seconds (median {cpu[len(cpu) // 2]:.3f}), "
                    f"{wall[0]:.3f} s, {memory[0]:.0f} MB",
                    flush=True,
                )


main()
