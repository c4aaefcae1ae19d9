"""The console script `rins`: the command itself."""

from __future__ import annotations

import sys

from ._rins import command


def main() -> int:
    """Run the command line of this process, and return its exit code."""
    return command(["rins", *sys.argv[1:]])
