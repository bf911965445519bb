#!/usr/bin/env python3
"""Times `watch` from a save to the picture: watch.py ROUNDS SCENE PROGRAM [ARGUMENT...]

Starts `PROGRAM watch` on a copy of the scene and saves it again and again, each time with another
roll of the camera. The saves alternate between writing the file in place and replacing it by
renaming. All times are in milliseconds: minimum, median and maximum.

Prints the time from the beginning of the save until the new picture is there, and the time that the
program itself prints; then the mean processor time of a picture. For comparison, prints the time of
`PROGRAM render` from start to exit, for the same scenes and for pictures of one pixel."""

import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time


def line(name, seconds):
    times = sorted(1000 * second for second in seconds)
    print(f"{name:24} {times[0]:6.1f} {statistics.median(times):6.1f} {times[-1]:6.1f}")


def wait(happened):
    start = time.monotonic()
    while not happened():
        if time.monotonic() - start > 60:
            sys.exit("nothing happens")
        time.sleep(0.0005)


def save(scene, text, by_renaming):
    if by_renaming:
        other = scene.with_suffix(".new")
        other.write_text(text)
        os.rename(other, scene)
    else:
        scene.write_text(text)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    rounds, original, program = int(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    text = original.read_text()
    if "roll   0deg" not in text:
        sys.exit(f"{original} has no `roll   0deg` to change")
    texts = [text.replace("roll   0deg", f"roll   {roll}deg") for roll in range(1, rounds + 1)]
    with tempfile.TemporaryDirectory(dir=".") as folder:
        scene, picture = pathlib.Path(folder, "scene.scn"), pathlib.Path(folder, "scene.png")
        scene.write_text(text)
        watch = subprocess.Popen([program, "watch", scene, *sys.argv[4:]], stderr=subprocess.PIPE, text=True)
        said = []
        threading.Thread(target=lambda: said.extend(watch.stderr), daemon=True).start()
        wait(lambda: len(said) >= 2)
        seen = {}
        for number, text in enumerate(texts):
            # A user does not save at the very moment when the last picture appears, so a pause is
            # made.
            time.sleep(0.2)
            by_renaming = number % 2 == 1
            before, start = picture.stat().st_ino, time.monotonic()
            save(scene, text, by_renaming)
            wait(lambda: picture.stat().st_ino != before)
            seen.setdefault(by_renaming, []).append(time.monotonic() - start)
            wait(lambda: len(said) >= number + 3)
        watch.terminate()
        _, _, usage = os.wait4(watch.pid, 0)
        print(f"{'':24}  least median   most")
        line("saved in place", seen[False])
        line("saved by renaming", seen[True])
        line("as the program says", [float(re.search(r"([\d.]+) ms", words)[1]) / 1000 for words in said[2:]])
        processor = (usage.ru_utime + usage.ru_stime) / len(said[1:])
        print(f"processor time of each   {1000 * processor:6.1f}")
        for name, sets in [("render", []), ("render of one pixel", ["image.width=1", "image.height=1"])]:
            times = []
            for text in texts:
                scene.write_text(text)
                start = time.monotonic()
                arguments = [word for value in sets for word in ("--set", value)]
                subprocess.run([program, "render", scene, "-o", picture, *arguments], check=True)
                times.append(time.monotonic() - start)
            line(name, times)


main()
