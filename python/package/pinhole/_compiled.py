"""The compiled part of the module. It has no annotations: those of its callers are checked."""

from __future__ import annotations

from importlib import import_module
from typing import Any

native: Any = import_module("pinhole._native")
