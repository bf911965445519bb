"""Renders a scene by Mitsuba 3 and writes the picture: mitsuba_render.py VARIANT THREADS SAMPLER
SAMPLES SCENE PICTURE [AGAIN]

Does what the `mitsuba` command does, but also writes PNG files. Prints, as JSON, the seconds of
wall time of each phase: importing, loading the scene, rendering, writing, and, if AGAIN is given,
the least of three times that rendering takes when nothing is left to compile."""

import json
import sys
import time

start = time.perf_counter()

import drjit
import mitsuba


def main():
    variant, threads, sampler, samples, scene, picture = sys.argv[1:7]
    seconds = {}
    last = start

    def done(phase):
        nonlocal last
        now = time.perf_counter()
        seconds[phase] = now - last
        last = now

    mitsuba.set_variant(variant)
    drjit.set_thread_count(int(threads))
    done("import")
    loaded = mitsuba.load_file(scene, sampler=sampler, samples=samples)
    done("load")
    image = rendered(loaded, 0)
    done("render")
    mitsuba.util.write_bitmap(picture, image, write_async=False)
    done("write")
    if len(sys.argv) > 7:
        times = []
        for seed in range(1, 4):
            rendered(loaded, seed)
            done("again")
            times.append(seconds["again"])
        seconds["again"] = min(times)
    print(json.dumps(seconds))


def rendered(scene, seed):
    """Renders the scene. The LLVM variants do so only when the result is evaluated."""
    image = mitsuba.render(scene, seed=seed)
    if mitsuba.variant().startswith("llvm"):
        drjit.eval(image)
        drjit.sync_thread()
    return image


main()
