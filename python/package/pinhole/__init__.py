"""Renders Pinhole's scenes to arrays, and says what is wrong with other programs' pictures.

>>> import pinhole
>>> scene = pinhole.Scene("camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere { center (0, 1, 0) }")
>>> scene.render().shape
(720, 1280, 3)

A picture is an array with three axes: rows from the top, columns from the left, and red, green and
blue. Integers are in sRGB, as in files and on screens. Floats are linear light from 0 to 1, in
which the mean of two colours is the mean of their numbers.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

    from ._problems import Edit, Fix, Label, Problem, Problems, SceneError
    from ._scene import Crop, Picture, Scene, Settings, Value, check, load
else:

    def __getattr__(name: str) -> Any:
        """Imports a name at its first use, so that the program starts without all modules."""
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        homes = (import_module(home, __name__) for home in ("._scene", "._problems"))
        globals()[name] = next(getattr(home, name) for home in homes if hasattr(home, name))
        return globals()[name]

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})

__all__ = [
    "Crop",
    "Edit",
    "Fix",
    "Label",
    "Picture",
    "Problem",
    "Problems",
    "Scene",
    "SceneError",
    "Settings",
    "Value",
    "check",
    "load",
]


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Adds the cell magic `%%scn` to a notebook: `%load_ext pinhole`."""
    from ._magic import SceneMagic

    shell.register_magics(SceneMagic)
