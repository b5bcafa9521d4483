"""The process in place of a Python function: it passes the questions of mbint to the process that has the function.

Started as ``python _answering.py ADDRESS``; the key is in the variable ``MBINT_ANSWERING_KEY``. It imports nothing but the standard
library, so that it starts quickly.
"""

from __future__ import annotations

import os
import sys
from multiprocessing.connection import Client


def main() -> None:
    """Passes lines to the connection and its answers back, until the input ends."""
    with Client(sys.argv[1], authkey=bytes.fromhex(os.environ["MBINT_ANSWERING_KEY"])) as connection:
        for line in sys.stdin.buffer:
            connection.send_bytes(line)
            while answer := connection.recv_bytes():
                sys.stdout.buffer.write(answer)
            sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
