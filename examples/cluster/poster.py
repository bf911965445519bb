"""Renders a scene by the workers of a Dask cluster: poster.py SCENE PICTURE [SCHEDULER].

SCHEDULER is an address such as `tcp://node1:8786`. Without it, workers are started on this machine.
"""

from __future__ import annotations

import sys

import pinhole
import pinhole.dask
from distributed import Client


def main() -> None:
    scene, picture, *scheduler = sys.argv[1:]
    with Client(*scheduler):
        pinhole.dask.save(pinhole.load(scene), picture)


if __name__ == "__main__":
    main()
