"""Renders Pinhole's scenes to arrays, and says what is wrong with other programs' pictures.

>>> import pinhole
>>> scene = pinhole.Scene("camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere { center (0, 1, 0) }")
>>> scene.render().shape
(720, 1280, 3)

Pictures are arrays of rows from the top, columns from the left, and red, green and blue. Those of
whole numbers are in sRGB, as files and screens have them. Those of floats are in linear light from
0 to 1, in which the mean of two colours is a mean of their numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._problems import Edit, Fix, Label, Problem, Problems, SceneError
from ._scene import Crop, Picture, Scene, Settings, Value, check, load

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

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
