"""The command-line program `pinhole`."""

from __future__ import annotations

import signal
import sys


def main() -> int:
    """Runs the program with the arguments of this process, and returns its exit status."""
    # Ctrl-C during the import ends the process without a traceback. If Ctrl-C is ignored, as by a
    # job in the background, it continues to be ignored.
    interrupt = signal.getsignal(signal.SIGINT)
    if interrupt is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ._compiled import native

    signal.signal(signal.SIGINT, interrupt)
    # These signals act like Ctrl-C: the command removes its temporary files before it ends.
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    status: int = native.program(["pinhole", *sys.argv[1:]])
    return status


if __name__ == "__main__":
    sys.exit(main())
