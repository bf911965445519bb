"""Names of the files that pictures are written to."""

from __future__ import annotations

import os
import warnings


def is_exr(path: str) -> bool:
    """Returns whether a path ends in `.exr` rather than `.png`. Any other ending is an error."""
    ending = os.path.splitext(path)[1].lower()
    if ending not in (".exr", ".png"):
        raise ValueError(
            f"the ending of {path} stands for no format: a picture's file ends in .png or .exr"
        )
    return ending == ".exr"


def warn_of_length(path: str) -> None:
    """Warns the caller of a method of this package that a file lacks the scene's text."""
    reason = "the scene has more than 1 MiB of text or 1000 settings"
    warnings.warn(f"{reason}, so {path} does not carry it", stacklevel=3)
