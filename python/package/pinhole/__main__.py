"""The command-line program `pinhole`."""

from __future__ import annotations

import signal
import sys


def main() -> int:
    """Runs the program with the arguments of this process, and returns its exit status."""
    # Ctrl-C during the import ends the process without a traceback. A signal that is ignored, as
    # those of a job in the background are, stays so.
    interrupt = signal.getsignal(signal.SIGINT)
    if interrupt is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ._compiled import native

    signal.signal(signal.SIGINT, interrupt)
    # A command removes its temporary files after these signals, too, as after Ctrl-C.
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    status: int = native.program(["pinhole", *sys.argv[1:]])
    return status


if __name__ == "__main__":
    sys.exit(main())
