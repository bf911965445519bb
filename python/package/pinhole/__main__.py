"""The command-line program `pinhole`."""

from __future__ import annotations

import signal
import sys

from ._compiled import native


def main() -> int:
    """Runs the program with the arguments of this process, and returns its exit status."""
    # A command removes its temporary files after these signals, too, as after Ctrl-C. A signal that
    # is ignored, as under `nohup`, stays so.
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    status: int = native.program(["pinhole", *sys.argv[1:]])
    return status


if __name__ == "__main__":
    sys.exit(main())
