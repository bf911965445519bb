#!/usr/bin/env python3
"""Compares Pinhole, POV-Ray and Mitsuba 3 on the same scenes: compare.py figure|many SCENE...
[options]

With `--rival`, `figure` also measures `rival.c`, a program for figure 9.9 alone.

Times whole processes in turns, from the start to the picture on disk, as PNG of 8 bits, on two
threads: CPU seconds (user and system time of all threads), wall time and peak memory. `figure` also
measures each picture's error, against Pinhole's exact one and in linear light, from another run
that writes OpenEXR (the rival's error, from its PNG). Nothing but Python and the programs is
needed; see README.md in the folder above."""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
THREADS = 2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["figure", "many"])
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--pinhole", default="pinhole", help="the program")
    parser.add_argument("--povray", default="povray", help="the program")
    parser.add_argument("--mitsuba", default=sys.executable, metavar="PYTHON", help="the Python that has Mitsuba")
    parser.add_argument("--rival", help="the program; README.md in the folder above says how it is built")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="one round of a small picture, to see that all works")
    options = parser.parse_args()
    if options.quick:
        options.rounds = 1
    for program in ["pinhole", "povray", "mitsuba"] + ["rival"] * (options.rival is not None):
        found = shutil.which(getattr(options, program))
        if found is None:
            sys.exit(f"{getattr(options, program)} is not there")
        # The processes run in another folder, so paths must be absolute.
        setattr(options, program, os.path.abspath(found))
    for scene in options.scenes:
        with tempfile.TemporaryDirectory() as folder:
            compare(options, os.path.abspath(scene), folder)


def compare(options, scene, folder):
    sets = ["--set", "image.width=320", "--set", "image.height=180"] if options.quick else []
    inspected = os.path.join(folder, "inspected.json")
    with open(inspected, "w") as file:
        subprocess.run([options.pinhole, "inspect", scene, "--format", "json", *sets], stdout=file, check=True)
    # The scene is converted in a separate process. A child's peak memory includes that of this
    # process, which must therefore stay small.
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), inspected, folder], check=True)
    with open(inspected) as file:
        size = json.loads(re.match(r'\{"image":(\{.*?\})', file.read(200))[1])
    ways = list((figure if options.what == "figure" else many)(options, scene, sets, size))
    errors = {}
    if options.what == "figure":
        errors = measure_errors(options, ways, scene, folder)
    measured = {name: [] for name, *_ in ways}
    phases = {name: [] for name, *_ in ways}
    others, loads = [], []
    # The first run of a program is slower, because caches, such as Mitsuba's compiled kernels, are
    # still empty. If errors were measured, the pictures for that have filled the caches. Otherwise,
    # round 0 fills the caches, and does not count.
    for number in range(1 if errors else 0, options.rounds + 1):
        for name, command, fresh in ways:
            before = busy_seconds(), time.monotonic()
            numbers, said = run(command("picture.png"), folder, fresh)
            if number > 0:
                passed = time.monotonic() - before[1]
                others.append(max(0.0, busy_seconds() - before[0] - numbers[0]) / passed)
                loads.append(os.getloadavg()[0])
                measured[name].append(numbers)
                phases[name].append(told(said))
    print(
        f"{os.path.basename(scene)}, {size['width']} x {size['height']}, {options.rounds} rounds, load (with this) {spread(loads)}, "
        f"processors that other work took {spread(others)}"
    )
    print("| what | CPU s | wall s | peak MB |" + (" RMSE |" if errors else " phases, s |"))
    print("| --- | --- | --- | --- | --- |")
    for name, *_ in ways:
        cpu, wall, memory = ([run[at] for run in measured[name]] for at in range(3))
        last = f"{errors[name]:.4f}" if errors else ""
        each = [f"{phase} {statistics.median(run[phase] for run in phases[name]):.2f}" for phase in phases[name][0]]
        print(f"| {name} | {spread(cpu)} | {spread(wall)} | {statistics.median(memory):.0f} | {last or ', '.join(each)} |")
        if errors and each:
            print(f"{name}: {', '.join(each)}", file=sys.stderr)
    sys.stdout.flush()


def figure(options, scene, sets, size):
    """Yields the ways to render figure 9.9. Each has a name, a function from a picture's path to
    the command, and whether it starts without anything that an earlier run has compiled."""
    counts = {"hammersley": [16, 46, 64], "multi_jittered": [16, 48, 64], "sobol": [16, 48, 64]}
    for method, samples in [(method, samples) for method in counts for samples in counts[method]]:
        chosen = [f"sampler.method={method}", f"sampler.per_pixel={samples}"]
        yield f"Pinhole, {method}, {samples}", pinhole(options, scene, sets, chosen), False
    yield "Pinhole, exact", pinhole(options, scene, sets, ["sampler.method=exact"]), False
    if options.rival is not None and not options.quick:
        for samples in [46, 64]:
            yield f"rival, {samples}", rival(options, samples), False
    yield "POV-Ray, every pixel, 4 x 4", povray(options, size, 0, 4), False
    yield "POV-Ray, every pixel, 8 x 8", povray(options, size, 0, 8), False
    yield "POV-Ray, every pixel, 9 x 9", povray(options, size, 0, 9), False
    yield "POV-Ray, adaptive, 9 x 9", povray(options, size, 0.001, 9), False
    for sampler, samples in [("ldsampler", 4), ("ldsampler", 16), ("multijitter", 48), ("ldsampler", 64)]:
        yield f"Mitsuba, LLVM, {sampler}, {samples}", mitsuba(options, "llvm_ad_rgb", sampler, samples), False
    yield "Mitsuba, LLVM, ldsampler, 16, first run", mitsuba(options, "llvm_ad_rgb", "ldsampler", 16), True
    for samples in [4, 16, 64]:
        yield f"Mitsuba, scalar, ldsampler, {samples}", mitsuba(options, "scalar_rgb", "ldsampler", samples), False


def many(options, scene, sets, size):
    """Yields the ways for many objects, with which POV-Ray is faster with its second kind of
    bounding, a tree."""
    chosen = ["sampler.method=jittered", "sampler.per_pixel=4"]
    yield "Pinhole, jittered, 4", pinhole(options, scene, sets, chosen), False
    yield "POV-Ray, every pixel, 2 x 2", povray(options, size, 0, 2, ["+BM2"]), False
    for name, variant in [("LLVM", "llvm_ad_rgb"), ("scalar", "scalar_rgb")]:
        yield f"Mitsuba, {name}, multijitter, 4", mitsuba(options, variant, "multijitter", 4), False


def pinhole(options, scene, sets, chosen):
    arguments = [options.pinhole, "render", scene, "--threads", str(THREADS), *sets]
    for value in chosen:
        arguments += ["--set", value]
    return lambda picture: [*arguments, "-o", picture]


def rival(options, samples):
    """Returns the command for the rival, which knows only figure 9.9 at 1280 x 720 pixels."""
    return lambda picture: [options.rival, str(samples), str(THREADS), picture, "-"]


def povray(options, size, threshold, side, more=()):
    """Returns the command for POV-Ray with its first kind of antialiasing: a fully jittered grid of
    samples in each pixel that differs from a neighbour by the threshold or more."""
    arguments = [options.povray, "+Iscene.pov", f"+W{size['width']}", f"+H{size['height']}", f"+WT{THREADS}", "-D", "-V"]
    arguments += ["+AM1", f"+A{threshold:.3f}", f"+R{side}", "+J1", *more]
    return lambda picture: [*arguments, f"+O{picture}", "+FE" if picture.endswith("exr") else "+FN8"]


def mitsuba(options, variant, sampler, samples):
    arguments = [options.mitsuba, os.path.join(HERE, "mitsuba_render.py"), variant, str(THREADS), sampler, str(samples)]
    return lambda picture: [*arguments, "scene.xml", picture]


def run(arguments, folder, fresh):
    """Returns CPU seconds, wall time and peak memory in MB, and the output of the process."""
    home = os.path.join(folder, "home")
    if fresh:
        home = tempfile.mkdtemp(dir=folder)
    os.makedirs(home, exist_ok=True)
    said = os.path.join(folder, "said.txt")
    with open(said, "w") as output:
        start = time.monotonic()
        process = subprocess.Popen(
            arguments, cwd=folder, stdout=output, stderr=subprocess.STDOUT, env={**os.environ, "HOME": home}
        )
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - start
    with open(said, errors="replace") as output:
        text = output.read()
    if status != 0:
        sys.exit(f"{' '.join(arguments)} failed:\n{text[-2000:]}")
    return (usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024), text


def busy_seconds():
    """Returns the seconds that all processors together were busy since the machine started."""
    with open("/proc/stat") as file:
        user, nice, system, _, _, *interrupts = map(int, file.readline().split()[1:9])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def told(text):
    """Returns the seconds of a program's phases, if it prints them: CPU seconds for POV-Ray, wall
    seconds for Mitsuba."""
    seconds = {}
    for phase, spent in re.findall(r"(Parse|Bounding|Trace) Time:.*\n\s+using.* with ([\d.]+) CPU-seconds", text):
        seconds[phase.lower()] = float(spent)
    for line in text.splitlines():
        if line.startswith('{"import"'):
            seconds.update(json.loads(line))
    return seconds


def measure_errors(options, ways, scene, folder):
    exact = os.path.join(folder, "exact.exr")
    as_exact = dict((name, command) for name, command, _ in ways)["Pinhole, exact"]
    run(as_exact(exact), folder, False)
    rivals_exact = exact_for_rival(options, scene, folder) if options.rival is not None else None
    errors = {}
    for name, command, _ in ways:
        is_rival = name.startswith("rival")
        picture = "picture.png" if is_rival else "picture.exr"
        arguments = command(picture)
        _, text = run(arguments + ["again"] if "LLVM" in name else arguments, folder, False)
        if "LLVM" in name:
            print(f"{name}: rendered once more in {told(text)['again']:.2f} s of wall time", file=sys.stderr)
        reference = rivals_exact if is_rival else exact
        said = subprocess.run(
            [options.pinhole, "diff", picture, reference, "--format", "json"], cwd=folder, stdout=subprocess.PIPE
        )
        errors[name] = json.loads(said.stdout)["rmse"]
    return errors


def exact_for_rival(options, scene, folder):
    """Renders the exact picture for the rival's camera, and returns its path. The rival has an angle
    of view of 40 degrees instead of the figure's `d`, which makes a slightly different picture."""
    path, angle = (os.path.join(folder, name) for name in ["rivals_exact.exr", "angle.scn"])
    with open(scene) as read, open(angle, "w") as write:
        write.write(re.sub(r"\bd\s+2\.75", "fov 40deg", read.read()))
    run([options.pinhole, "render", angle, "--set", "sampler.method=exact", "-o", path], folder, False)
    return path


def spread(values):
    median = statistics.median(values)
    digits = 3 if median < 1 else 2
    return f"{median:.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


main()
