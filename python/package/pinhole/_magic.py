"""The cell magic `%%scn` of notebooks."""

from __future__ import annotations

import argparse
import shlex
from typing import NoReturn

from IPython.core.error import UsageError
from IPython.core.magic import Magics, cell_magic, magics_class
from IPython.display import display

from ._scene import Scene


class _Arguments(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}\n{self.format_usage().strip()}")


@magics_class
class SceneMagic(Magics):
    """Adds `%%scn`."""

    @cell_magic
    def scn(self, line: str, cell: str) -> Scene:
        """Reads the cell as a scene, shows its picture, and gives it a name.

        %%scn NAME --set TARGET=VALUE --set TARGET=VALUE
        """
        parser = _Arguments(prog="%%scn", add_help=False)
        parser.add_argument("name", help="the variable that gets the scene")
        parser.add_argument("--set", action="append", default=[], metavar="TARGET=VALUE")
        arguments = parser.parse_args(shlex.split(line))
        if not arguments.name.isidentifier():
            parser.error(f"{arguments.name} is not the name of a variable")
        scene = Scene(cell, arguments.set, arguments.name)
        if self.shell is not None:
            self.shell.user_ns[arguments.name] = scene
        if scene.problems:
            display(scene.problems)  # type: ignore[no-untyped-call]
        return scene
