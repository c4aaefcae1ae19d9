"""Progress reports."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Report = Callable[[str, "int | None", "int | None"], object]
"""A function of the stage in words, the number of its parts that are done, and the number of its parts, if these are known."""


def listener(progress: bool | Report) -> Report | None:
    """The function for progress reports: none, a bar of tqdm, or the given function."""
    if progress is False:
        return None
    if progress is True:
        return _bar()
    return progress


def _bar() -> Report:
    from tqdm.auto import tqdm

    bars: list[Any] = []

    def report(stage: str, done: int | None, total: int | None) -> None:
        if done == 0 or not bars:
            while bars:
                bars.pop().close()
            bars.append(tqdm(desc=stage, total=total, leave=False))
        bar = bars[-1]
        bar.set_description(stage, refresh=False)
        if done is not None:
            bar.update(done - bar.n)
            if done == total:
                bars.pop().close()

    return report
