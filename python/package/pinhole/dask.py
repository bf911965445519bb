"""Renders scenes by Dask: on the processors of one machine, or on many machines.

>>> import pinhole, pinhole.dask
>>> scene = pinhole.load("poster.scn", set={"image.width": 16384, "image.height": 16384})
>>> picture = pinhole.dask.render(scene)          # an array of Dask, of which nothing is rendered yet
>>> picture[:512, :512].compute()                 # the blocks of a part
>>> dask.array.to_zarr(picture, "poster.zarr")    # all blocks, to a folder
>>> pinhole.dask.save(scene, "poster.png")        # the bytes that `pinhole render` writes

The pixels of a block do not depend on the other blocks, on the machine, or on how often the block
is rendered. If a worker dies, its blocks are rendered by others, and the picture is the same.

It needs the optional dependencies `dask` of the distribution `pinhole-scn`.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeAlias

import dask
import dask.array as da
import numpy as np

from ._compiled import native
from ._files import is_exr, warn_of_length
from ._scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

Chunks: TypeAlias = int | tuple[int, int]
"""Side of the square blocks of a picture, in pixels, or their numbers of rows and columns."""

_ROWS = 64
"""Number of rows that are written at a time. Ctrl-C is noticed between two writes."""


def render(scene: Scene, chunks: Chunks = 1024) -> da.Array:
    """Returns the picture in sRGB, as `Scene.render` does, as an array of blocks.

    A block is rendered by one thread, since Dask works on several blocks at once.
    """
    return _blocks(scene, chunks, Scene.render, np.dtype(np.uint8))


def render_linear(scene: Scene, chunks: Chunks = 1024) -> da.Array:
    """Returns the picture in linear light, as `Scene.render_linear` does, as an array of blocks."""
    return _blocks(scene, chunks, Scene.render_linear, np.dtype(np.float64))


def save(scene: Scene, path: str | os.PathLike[str], chunks: Chunks = 1024) -> None:
    """Renders to a file with the bytes that `Scene.save` writes: `.png`, or `.exr`.

    The workers render one row of blocks while this process writes the row above, so that only two
    rows of blocks are in memory.
    """
    path = os.fspath(path)
    if is_exr(path):
        write, picture = native.write_exr, _blocks(scene, chunks, _light, np.dtype(np.float32))
    else:
        write, picture = native.write_png, render(scene, chunks)
    if not write(scene._native, path, _bands(picture)):
        warn_of_length(path)


def _blocks(scene: Scene, chunks: Chunks, method: Any, dtype: np.dtype[Any]) -> da.Array:
    rows, columns = (chunks, chunks) if isinstance(chunks, int) else chunks
    shape = (scene.height, scene.width, 3)
    sizes = da.core.normalize_chunks((rows, columns, 3), shape)
    # The scene is a value of the task graph, so each worker gets it once. If it were scattered to a
    # worker, it would be lost when this worker dies.
    shared = dask.delayed(scene, pure=True, traverse=False)
    return da.map_blocks(
        _block,
        shared,
        method,
        chunks=sizes,
        dtype=dtype,
        meta=np.empty((0, 0, 0), dtype),
        name=f"pinhole-{dask.base.tokenize(scene, method.__name__, sizes)}",
    )


def _block(scene: Scene, method: Any, block_info: Any = None) -> NDArray[Any]:
    (top, bottom), (left, right), _ = block_info[None]["array-location"]
    block: NDArray[Any] = method(scene, (left, top, right - left, bottom - top), threads=1)
    return block


def _light(scene: Scene, crop: tuple[int, int, int, int], threads: int) -> NDArray[np.float32]:
    """Renders a block with the precision of an EXR file."""
    return scene.render_linear(crop, threads).astype(np.float32)


def _bands(picture: da.Array) -> Iterator[NDArray[Any]]:
    """Computes the rows of blocks from the top, and yields a few rows at a time."""
    ahead: deque[da.Array] = deque()
    for index in range(picture.numblocks[0]):
        # If there is a cluster, it starts to compute, and this call returns at once. Without a
        # cluster, the call returns when the blocks are computed.
        ahead.append(picture.blocks[index].persist())
        if len(ahead) > 1:
            yield from _pieces(ahead.popleft())
    yield from _pieces(ahead.popleft())


def _pieces(band: da.Array) -> Iterator[NDArray[Any]]:
    rows = np.ascontiguousarray(band.compute())
    for top in range(0, len(rows), _ROWS):
        yield rows[top : top + _ROWS]
