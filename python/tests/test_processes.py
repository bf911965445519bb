"""Tests of threads, processes and signals, and of the overhead of a call."""

from __future__ import annotations

import pickle
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pinhole
import pytest
from conftest import ENDLESS, LONG_PIXEL, TEXT

Python = Callable[[str], "subprocess.Popen[str]"]


@pytest.fixture(scope="module")
def many() -> pinhole.Scene:
    """A scene of 10⁵ spheres."""
    at = np.random.default_rng(1).uniform(-20, 20, (100_000, 3)).round(3)
    spheres = "".join(f"sphere {{ center ({x}, {y}, {z})  radius 0.1 }}\n" for x, y, z in at)
    return pinhole.Scene(
        "image { width 64  height 64 }\ncamera { eye (0, 0, 60)  lookat (0, 0, 0) }\n" + spheres
    )


def test_a_scene_is_the_same_after_pickling(scene: pinhole.Scene) -> None:
    rolled = pinhole.Scene(TEXT, {"camera.roll": "8deg"}, name="rolled")
    again = pickle.loads(pickle.dumps(rolled))
    assert again == rolled != scene and hash(again) == hash(rolled)
    assert (again.text, again.set, again.name) == (TEXT, ("camera.roll=8deg",), "rolled")
    np.testing.assert_array_equal(again.render(), rolled.render())
    assert len(pickle.dumps(rolled)) < len(TEXT) + 200


def test_errors_are_pickled_with_their_problems() -> None:
    with pytest.raises(pinhole.SceneError) as caught:
        pinhole.Scene("sphere { radius -1 }")
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.problems == caught.value.problems and str(again) == str(caught.value)


def test_a_scene_of_many_spheres_is_read_once(many: pinhole.Scene) -> None:
    bytes_ = pickle.dumps(many)
    start = time.perf_counter()
    first = pickle.loads(bytes_)
    once = time.perf_counter() - start
    start = time.perf_counter()
    assert all(pickle.loads(bytes_) is first for _ in range(20))
    assert time.perf_counter() - start < once


def test_processes_render_the_blocks_of_a_scene(many: pinhole.Scene) -> None:
    blocks = [(0, y, 64, 4) for y in range(0, 64, 4)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        rows = list(pool.map(many.render, blocks, timeout=60))
    np.testing.assert_array_equal(np.concatenate(rows), many.render())


def test_a_forked_process_renders(python: Python) -> None:
    start = time.monotonic()
    script = python("""
import multiprocessing, pinhole
scene = pinhole.Scene(TEXT)
before = scene.render()
scene.grade(before)
with multiprocessing.get_context("fork").Pool(2) as pool:
    for picture in pool.map(pinhole.Scene.render, [scene] * 4):
        assert (picture == before).all()
    print(pool.map(scene.grade, [before])[0]["verdict"])
""")
    output, _ = script.communicate(timeout=30)
    assert (output, script.returncode) == ("noise\n", 0)
    assert time.monotonic() - start < 10


def test_threads_share_a_scene(scene: pinhole.Scene) -> None:
    expected = scene.render()
    fresh = pinhole.Scene(TEXT)
    with ThreadPoolExecutor(8) as pool:
        pictures = pool.map(lambda n: fresh.render(threads=n % 3 + 1), range(32))
        verdicts = pool.map(lambda _: fresh.grade(expected)["verdict"], range(8))
    assert all((picture == expected).all() for picture in pictures)
    assert set(verdicts) == {"noise"}


def test_other_threads_of_python_go_on(scene: pinhole.Scene) -> None:
    slow = pinhole.Scene(TEXT, {"sampler.per_pixel": 20_000})
    done = threading.Event()

    def render() -> None:
        slow.render()
        done.set()

    thread = threading.Thread(target=render)
    thread.start()
    turns = 0
    while not done.wait(0.005):
        turns += 1
    thread.join()
    assert turns > 10


@pytest.mark.parametrize(
    "call",
    [
        "scene.render()",
        "scene.save('a.png')",
        "long_pixel.render_exact()",
        "long_pixel.grade(__import__('numpy').zeros((1, 1, 3), 'uint8'))",
        "pinhole.Scene(TEXT + 'sphere { center (0, 1, 0) }\\n' * 1_000_000)",
    ],
)
def test_ctrl_c_ends_a_call_within_100_ms(python: Python, tmp_path: Path, call: str) -> None:
    def latency() -> float:
        # The call begins during the pause before the signal. The script's time can be compared with
        # this process's, since all processes of a machine have the same monotonic clock.
        script = python(f"""
import pinhole, time
scene, long_pixel = pinhole.Scene(TEXT, {ENDLESS!r}), pinhole.Scene({LONG_PIXEL!r})
print("ready")
try:
    {call}
except KeyboardInterrupt:
    print(time.monotonic())
""")
        assert script.stdout and script.stdout.readline() == "ready\n"
        time.sleep(0.3)
        pressed = time.monotonic()
        script.send_signal(signal.SIGINT)
        output, _ = script.communicate(timeout=20)
        return float(output) - pressed

    # A machine with other work may take longer now and then.
    assert min(latency() for _ in range(3)) < 0.1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["script.py"]


def test_a_small_call_costs_little() -> None:
    def fastest(call: Callable[[], object]) -> float:
        times = []
        for _ in range(50):
            start = time.perf_counter()
            call()
            times.append(time.perf_counter() - start)
        return min(times)

    scene = pinhole.Scene(TEXT, {"image.width": 320, "image.height": 180})
    # Nearly all of the time for one pixel is overhead of the call and of starting threads.
    pixel, whole = fastest(lambda: scene.render(crop=(0, 0, 1, 1))), fastest(scene.render)
    assert pixel < 0.3 * whole
