"""The compiled part of the module. It has no type annotations; the code that calls it has."""

from __future__ import annotations

from importlib import import_module
from typing import Any

native: Any = import_module("pinhole._native")
