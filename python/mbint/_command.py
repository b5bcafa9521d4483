"""The command ``mbint``: where it is, and how it is run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path

#: Exit status if a number is unreliable, and if a requirement is not met (see docs/reference/exit-codes.md).
UNRESOLVED = 3
NOT_MET = 4

#: Exit statuses of ``mbint run`` after which there are results.
WITH_RESULTS = frozenset({0, UNRESOLVED, NOT_MET})

#: Exit status of ``mbint merge`` if another round of shards is needed.
ANOTHER_ROUND = 75


class MbintError(RuntimeError):
    """The command failed.

    Attributes:
        status: its exit status.
        message: its messages, with the locations in the model.
        code: kind of the first mistake, e.g. ``E0401``, whose page ``mbint explain`` shows; None if it has none.
    """

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message or f"mbint ended with status {status}")
        self.status = status
        self.message = message
        found = re.search(r"^error\[(E\d{4})\]", message, re.MULTILINE)
        self.code = found[1] if found else None


def command() -> str:
    """Path of the command.

    Searched for in the variable ``MBINT``, among the scripts of this Python, and on the PATH, in this order.

    Raises:
        FileNotFoundError: the command is in none of these.
    """
    if chosen := os.environ.get("MBINT"):
        if not (os.path.isfile(chosen) or shutil.which(chosen)):
            raise FileNotFoundError(f"the variable MBINT names {chosen}, and there is no such command")
        return chosen
    name = "mbint" + sysconfig.get_config_var("EXE") if sysconfig.get_config_var("EXE") else "mbint"
    schemes = (sysconfig.get_path("scripts"), sysconfig.get_path("scripts", f"{os.name}_user"))
    for folder in (*schemes, str(Path(sys.executable).parent)):
        if folder and (path := Path(folder) / name).is_file():
            return str(path)
    if path_on_path := shutil.which("mbint"):
        return path_on_path
    raise FileNotFoundError("the command `mbint` is not installed; `pip install mbint` brings it")


def invoke(arguments: Sequence[str], *, accepted: frozenset[int] = frozenset({0})) -> subprocess.CompletedProcess[str]:
    """Runs the command.

    Raises:
        MbintError: its exit status is not one of ``accepted``.
    """
    done = subprocess.run(
        [command(), *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, encoding="utf-8", check=False
    )
    if done.returncode not in accepted:
        raise MbintError(done.returncode, done.stderr.strip())
    return done


def version() -> str:
    """Version of the command."""
    return invoke(["--version"]).stdout.split()[-1]
