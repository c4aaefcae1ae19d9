"""A file system whose disk is full for the first files, for the tests of stores; workers import it."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

from fsspec import register_implementation
from fsspec.implementations.local import LocalFileSystem


class FullDisk(LocalFileSystem):  # type: ignore[misc]
    """The local disk, on which the first `times` files of all processes end with "no space left" half way.

    Parameters
    ----------
    counter : str
        A folder in which the failures are counted.
    times : int
        Their number.
    """

    protocol = "full"

    def __init__(self, counter: str, times: int, **options: Any) -> None:
        super().__init__(**options)
        self.counter, self.times = counter, times

    @classmethod
    def _strip_protocol(cls, path: str) -> str:
        return str(path).removeprefix("full://").rstrip("/")

    def put_file(self, source: str, target: str, **options: Any) -> None:
        for number in range(self.times):
            try:
                os.close(os.open(f"{self.counter}/{number}", os.O_CREAT | os.O_EXCL))
            except FileExistsError:
                continue
            content = Path(source).read_bytes()
            Path(target).write_bytes(content[: len(content) // 2])
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), target)
        super().put_file(source, target, **options)


register_implementation("full", FullDisk, clobber=True)
