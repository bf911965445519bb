"""Scenes: reading, rendering, and answers about them."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from operator import index
from typing import TYPE_CHECKING, Any, TypeAlias, Union

from . import _problems
from ._compiled import native
from ._files import is_exr, warn_of_length
from ._problems import Problems, SceneError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Picture: TypeAlias = NDArray[np.uint8 | np.uint16 | np.float32 | np.float64]
else:
    # NumPy is imported by the first picture, so that the program starts without it.
    Picture = Any

Value: TypeAlias = Union[str, float, Sequence[float]]
"""A value of a setting: an expression of the language, a number, or the numbers of a vector."""

Settings: TypeAlias = Union[Mapping[str, Value], Iterable[str]]
"""What `--set` overrides: `{"camera.roll": "8deg"}`, or the program's `["camera.roll=8deg"]`."""

Crop: TypeAlias = tuple[int, int, int, int]
"""A part of a picture: its left column, top row, width and height, in pixels."""


class Scene:
    """A scene, read from its text. It never changes, so that threads can share it.

    Raises `SceneError` if the text or a setting has errors.
    """

    __slots__ = ("__weakref__", "_name", "_native", "_problems", "_sets", "_text")

    def __init__(self, text: str, set: Settings = (), name: str = "scene") -> None:
        self._text, self._sets, self._name = text, _arguments(set), name
        self._native, self._problems = _read(text.encode(), self._sets, name)
        if self._native is None:
            raise SceneError(self._problems)

    @property
    def text(self) -> str:
        """The text, as it was given."""
        return self._text

    @property
    def set(self) -> tuple[str, ...]:
        """The settings, in the form of the program's `--set`."""
        return self._sets

    @property
    def name(self) -> str:
        """The name in reports: the file's path if the scene was loaded."""
        return self._name

    @property
    def width(self) -> int:
        """Number of columns of the picture."""
        width: int = self._native.size[0]
        return width

    @property
    def height(self) -> int:
        """Number of rows of the picture."""
        height: int = self._native.size[1]
        return height

    @property
    def problems(self) -> Problems:
        """The warnings about the text."""
        return self._problems

    def render(self, crop: Crop | None = None, threads: int | None = None) -> NDArray[np.uint8]:
        """Renders the picture, or a part of it, in sRGB.

        `threads` is the number of threads; by default, one per processor.
        """
        picture: NDArray[np.uint8] = self._native.render(*self._part(crop, threads))
        return picture

    def render_linear(
        self, crop: Crop | None = None, threads: int | None = None
    ) -> NDArray[np.float64]:
        """Renders the picture, or a part of it, in linear light."""
        picture: NDArray[np.float64] = self._native.render_linear(*self._part(crop, threads))
        return picture

    def render_exact(
        self, crop: Crop | None = None, threads: int | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Computes the means of the pixels without samples, in linear light.

        Also returns an error bound for each pixel: how far a channel may be from the true mean.
        """
        exact: tuple[NDArray[np.float64], NDArray[np.float32]]
        exact = self._native.render_exact(*self._part(crop, threads))
        return exact

    def save(
        self,
        path: str | os.PathLike[str],
        crop: Crop | None = None,
        threads: int | None = None,
    ) -> None:
        """Renders to a file with the bytes that the program writes.

        The path ends in `.png`, for sRGB with the scene's text in the file, or in `.exr`, for
        linear light. The file is written completely or not at all. A large picture is rendered and
        written in bands of rows, so that it need not fit into memory.
        """
        path, part = os.fspath(path), self._part(crop, threads)
        save = native.save_exr if is_exr(path) else native.save_png
        if not save(self._native, path, *part):
            warn_of_length(path)

    def probe(self, x: float, y: float) -> dict[str, Any]:
        """Follows the ray through a point of the picture, in pixels from its top left corner.

        Returns what `pinhole probe --format json` prints.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise ValueError(f"the point ({x}, {y}) is not finite")
        answer: dict[str, Any] = json.loads(self._native.probe(x, y))
        return answer

    def inspect(self) -> dict[str, Any]:
        """Returns what `pinhole inspect --format json` prints: camera, objects, and more."""
        answer: dict[str, Any] = json.loads(self._native.inspect())
        return answer

    def grade(self, picture: Picture, crop: Crop | None = None) -> dict[str, Any]:
        """Finds the mistakes in a picture of this scene, or of a part of it.

        Integers of 8 or 16 bits are read as sRGB, and floats as linear light. Returns what
        `pinhole diff PICTURE SCENE --format json` prints, without the names of the files.
        """
        import numpy as np

        array = np.ascontiguousarray(picture)
        if array.dtype.kind == "f":
            array = array.astype(np.float64, copy=False)
        if array.dtype not in (np.uint8, np.uint16, np.float64):
            raise ValueError(f"a picture of {array.dtype}: it takes uint8, uint16 or floats")
        _, _, width, height = crop or (0, 0, self.width, self.height)
        if array.shape != (height, width, 3):
            raise ValueError(
                f"the picture has the shape {array.shape}, and the scene's is {(height, width, 3)}"
            )
        verdict: dict[str, Any] = json.loads(self._native.grade(array, self._part(crop, None)[0]))
        return verdict

    def _part(self, crop: Crop | None, threads: int | None) -> tuple[list[int] | None, int | None]:
        """Checks a crop and a number of threads. Returns them in the form for the compiled part."""
        if threads is not None and index(threads) < 1:
            raise ValueError(f"{threads} threads cannot render: it takes 1 or more")
        threads = None if threads is None else min(index(threads), 1024)
        if crop is None:
            return None, threads
        numbers = [index(number) for number in crop]
        if len(numbers) != 4:
            raise ValueError(f"a crop has four numbers, X, Y, width and height, and not {crop}")
        x, y, width, height = numbers
        is_within = x >= 0 and y >= 0 and x + width <= self.width and y + height <= self.height
        if width < 1 or height < 1 or not is_within:
            raise ValueError(
                f"the crop {crop} has no pixels, or does not lie within the picture, "
                f"which has {self.width} × {self.height} pixels"
            )
        return numbers, threads

    def __repr__(self) -> str:
        return f"<Scene {self._name!r}, {self.width} × {self.height} pixels>"

    def _repr_png_(self) -> bytes:
        picture: bytes = self._native.png(None, None)
        return picture

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[str, tuple[str, ...], str]:
        return self._text, self._sets, self._name

    def __dask_tokenize__(self) -> tuple[str, ...]:
        """Returns the data by which scenes differ. Dask names the results of its tasks by them."""
        return "pinhole.Scene", self._text, *self._sets, self._name

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, self._key()


@lru_cache(maxsize=8)
def _unpickled(text: str, set: tuple[str, ...], name: str) -> Scene:
    """Reads a scene that was pickled. The cache avoids reading the same scene several times."""
    return Scene(text, set, name)


def load(path: str | os.PathLike[str], set: Settings = ()) -> Scene:
    """Reads a scene from a file: a `.scn`, or a PNG by Pinhole, which contains its scene.

    Settings are applied after those in a PNG. If a PNG shows only a part of a picture, the scene of
    the whole picture is read. Raises `SceneError` if the scene has errors.
    """
    with open(path, "rb") as file:
        data = file.read()
    name, settings = os.fspath(path), _arguments(set)
    try:
        carried: tuple[str, list[str]] | None = native.carried(data)
    except ValueError as error:
        raise ValueError(f"cannot read {name}: {error}") from None
    if carried is not None:
        return Scene(carried[0], (*carried[1], *settings), name)
    try:
        return Scene(data.decode(), settings, name)
    except UnicodeDecodeError:
        raise SceneError(_read(data, settings, name)[1]) from None


def check(text: str, set: Settings = (), name: str = "scene") -> Problems:
    """Returns the problems of a scene's text, errors and warnings, as `pinhole check` does."""
    return _read(text.encode(), _arguments(set), name)[1]


def _read(text: bytes, sets: tuple[str, ...], name: str) -> tuple[Any, Problems]:
    scene, problems, report = native.read(name, text, list(sets))
    return scene, _problems.from_json(problems, report)


def _arguments(settings: Settings) -> tuple[str, ...]:
    """Returns settings in the form of the program's `--set`."""
    if isinstance(settings, str):
        raise TypeError(
            'settings are a mapping such as {"camera.roll": "8deg"}, or a list of texts'
        )
    if not isinstance(settings, Mapping):
        return tuple(settings)
    return tuple(f"{target}={_expression(value)}" for target, value in settings.items())


def _expression(value: Value) -> str:
    """Writes a value in the language, so that numbers read back as they were."""
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        return f"({', '.join(map(_expression, value))})"
    return repr(float(value)).removesuffix(".0")
