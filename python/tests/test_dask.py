"""Tests of rendering by Dask: in this process, and by workers, one of which is killed."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import dask
import dask.array as da
import numpy as np
import pinhole
import pinhole.dask
import pytest
import zarr
from conftest import TEXT
from distributed import Client, LocalCluster

SLOW = {"image.width": 192, "image.height": 128, "sampler.per_pixel": 8000}
"""Settings of a picture whose blocks take long enough that a worker dies between two of them."""


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    """A scheduler in this process, with two processes as workers."""
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        yield client


def test_blocks_are_those_of_the_picture(scene: pinhole.Scene) -> None:
    picture = pinhole.dask.render(scene, chunks=20)
    assert (picture.shape, picture.dtype) == ((64, 96, 3), np.uint8)
    assert picture.chunks == ((20, 20, 20, 4), (20, 20, 20, 20, 16), (3,))
    np.testing.assert_array_equal(picture.compute(), scene.render())
    np.testing.assert_array_equal(picture[5:30, 40:].compute(), scene.render()[5:30, 40:])
    light = pinhole.dask.render_linear(scene, chunks=(10, 96))
    assert light.chunks == ((10, 10, 10, 10, 10, 10, 4), (96,), (3,))
    np.testing.assert_array_equal(light.compute(scheduler="sync"), scene.render_linear())


def test_blocks_have_sides_of_1024_pixels_by_default() -> None:
    huge = pinhole.Scene(TEXT, set={"image.width": 2**17, "image.height": 2**17})
    picture = pinhole.dask.render(huge)
    assert picture.chunksize == (1024, 1024, 3) and picture.numblocks == (128, 128, 1)
    corner = picture[-2:, -3:].compute(scheduler="sync")
    np.testing.assert_array_equal(corner, huge.render(crop=(2**17 - 3, 2**17 - 2, 3, 2)))


def test_equal_scenes_have_equal_names(scene: pinhole.Scene) -> None:
    def name(scene: pinhole.Scene, chunks: int = 20) -> str:
        return str(pinhole.dask.render(scene, chunks).name)

    rolled = pinhole.Scene(TEXT, {"camera.roll": "8deg"}, name="a.scn")
    assert name(scene) == name(pickle.loads(pickle.dumps(scene)))
    names = [name(scene), name(rolled), name(scene, 10)]
    names.append(str(pinhole.dask.render_linear(scene, 20).name))
    assert len(set(names)) == 4


def test_tasks_refer_to_the_scene_and_do_not_hold_it() -> None:
    scene = pinhole.Scene(TEXT + "// and so on\n" * 10_000)
    (picture,) = dask.optimize(pinhole.dask.render(scene, chunks=16))
    sizes = sorted(len(pickle.dumps(task)) for task in dict(picture.__dask_graph__()).values())
    assert len(sizes) >= 24 and sizes[-1] > 100_000 > 10_000 > sizes[-2]


def test_a_picture_goes_to_zarr(scene: pinhole.Scene, tmp_path: Path) -> None:
    da.to_zarr(pinhole.dask.render(scene, chunks=(16, 32)), str(tmp_path / "a.zarr"))
    stored = zarr.open_array(str(tmp_path / "a.zarr"), mode="r")
    assert stored.chunks == (16, 32, 3)
    np.testing.assert_array_equal(stored[:], scene.render())


@pytest.mark.parametrize("ending", ["png", "exr"])
@pytest.mark.parametrize("chunks", [1024, 20, (7, 96)])
def test_a_file_has_the_bytes_that_one_process_writes(
    scene: pinhole.Scene, tmp_path: Path, ending: str, chunks: pinhole.dask.Chunks
) -> None:
    scene.save(tmp_path / f"one.{ending}")
    pinhole.dask.save(scene, tmp_path / f"many.{ending}", chunks)
    one = (tmp_path / f"one.{ending}").read_bytes()
    assert (tmp_path / f"many.{ending}").read_bytes() == one


def test_what_cannot_be_saved_is_refused(scene: pinhole.Scene, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a picture's file ends in \.png or \.exr"):
        pinhole.dask.save(scene, tmp_path / "a.jpg")
    with pytest.raises(FileNotFoundError, match="cannot write to"):
        pinhole.dask.save(scene, tmp_path / "no" / "a.png")
    long = pinhole.Scene(TEXT + "// and so on\n" * 100_000)
    with pytest.warns(UserWarning, match="more than 1 MiB of text") as caught:
        pinhole.dask.save(long, tmp_path / "a.png")
    assert [Path(warning.filename).name for warning in caught] == ["test_dask.py"]


def test_an_error_in_a_block_leaves_no_file(
    scene: pinhole.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, threads: int) -> None:
        raise RuntimeError("the block is lost")

    monkeypatch.setattr(pinhole.Scene, "render", fail)
    with pytest.raises(RuntimeError, match="the block is lost"):
        pinhole.dask.save(scene, tmp_path / "a.png", 20)
    assert list(tmp_path.iterdir()) == []


def test_each_worker_reads_a_scene_once(client: Client) -> None:
    scene = pinhole.Scene(TEXT, name="read once")

    def misses() -> int:
        from pinhole._scene import _unpickled

        return _unpickled.cache_info().misses

    before = client.run(misses)
    picture = pinhole.dask.render(scene, chunks=16).compute()
    np.testing.assert_array_equal(picture, scene.render())
    after = client.run(misses)
    assert all(after[worker] - before[worker] <= 1 for worker in before)
    assert sum(after.values()) > sum(before.values())


def kill_a_worker(client: Client, start: Callable[[], object], blocks: int) -> object:
    """Calls `start`, and kills a worker when both workers together hold `blocks` blocks."""
    pids = client.run(os.getpid)
    killed = []

    def kill() -> None:
        deadline = time.monotonic() + 60
        while sum(len(keys) for keys in client.has_what().values()) < blocks:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        victim = next(iter(pids.values()))
        os.kill(victim, signal.SIGKILL)
        killed.append(victim)

    thread = threading.Thread(target=kill)
    thread.start()
    result = start()
    thread.join()
    client.wait_for_workers(2, timeout=60)
    assert killed and killed[0] not in client.run(os.getpid).values()
    return result


def test_a_worker_that_is_killed_changes_no_byte(client: Client, tmp_path: Path) -> None:
    slow = pinhole.Scene(TEXT, SLOW)
    picture = pinhole.dask.render(slow, chunks=16)
    expected = slow.render()
    result = kill_a_worker(client, picture.compute, blocks=10)
    np.testing.assert_array_equal(result, expected)
    slow.save(tmp_path / "one.png")
    kill_a_worker(client, lambda: pinhole.dask.save(slow, tmp_path / "many.png", 16), blocks=5)
    assert (tmp_path / "many.png").read_bytes() == (tmp_path / "one.png").read_bytes()
