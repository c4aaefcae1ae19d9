"""Shards of a Monte Carlo campaign in a store."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from . import _rins
from ._commands import monte_carlo
from ._errors import DataError, RinsError
from ._store import Store, digest_of
from ._tasks import DistributedError

_IDENTITY = "campaign.json"
"""The file in a store that states whose shards it holds."""

RUNS_OF_A_SHARD = 10_000
"""By default the most runs of a shard."""

_RUNS_OF_A_CHUNK = 64
"""The runs that are computed together: shards of less are no faster."""


class _Prepared(Exception):
    """The first shard begins."""


@dataclass(frozen=True)
class Campaign:
    """A campaign whose shards are computed on workers and put into a store."""

    name: str
    """The name of the scenario file, for messages and for the worker's copy."""
    scenario: bytes
    """The content of the scenario file: workers need not reach the file."""
    runs: int
    seed: int | None
    shards: int
    threads: int
    store: Store

    @property
    def identity(self) -> dict[str, object]:
        """What the numbers of the campaign depend on, and its division into shards."""
        return {
            "scenario_sha256": digest_of(self.scenario),
            "runs": self.runs,
            "seed": self.seed,
            "shards": self.shards,
            "version": _rins.VERSION,
        }

    def part(self, shard: int) -> str:
        """The name of the file of a shard in the store; names are of equal length, in the order of the shards."""
        return f"part-{shard:0{len(str(self.shards))}}.parquet"

    def parts(self) -> Iterator[str]:
        """The names of all shards' files."""
        return (self.part(shard) for shard in range(1, self.shards + 1))

    def identity_of(self, shard: int) -> dict[str, object]:
        """The identity of a shard, for its record."""
        return {**self.identity, "shard": shard}

    def check(self) -> None:
        """Prepare the first shard as a worker does: an error in the scenario or the arguments is raised before the campaign."""

        def stop(stage: str, done: int | None, total: int | None) -> None:
            raise _Prepared

        with contextlib.suppress(_Prepared):
            self._compute(1, None, stop).cleanup()

    def begin(self) -> None:
        """Claim the store for this campaign.

        Raises
        ------
        DataError
            If the store cannot be written, or holds the shards of another campaign.
        """
        try:
            there = stored_identity(self.store)
            if there is None:
                self.store.write(_IDENTITY, json.dumps(self.identity, indent=1).encode())
                there = stored_identity(self.store)
        except (OSError, ValueError, ImportError) as error:
            raise DataError(
                f"{self.store.url}: the store cannot be used: {error}", self.store.url
            ) from error
        for key, value in self.identity.items():
            if there is None or there.get(key) != value:
                found = None if there is None else there.get(key)
                raise DataError(
                    f"{self.store.name(_IDENTITY)}: {key}: the store holds a campaign with {found!r}, expected {value!r}; "
                    "choose another store, or the arguments of that campaign",
                    self.store.name(_IDENTITY),
                    None,
                    key,
                )

    def ensure_shard(self, shard: int) -> None:
        """Compute a shard on this worker and put it into the store, unless it is there with its recorded SHA-256.

        It is idempotent: a shard that is computed twice has the same bytes.
        """
        if stored_identity(self.store) != self.identity:
            self._refuse_worker()
        name, identity = self.part(shard), self.identity_of(shard)
        if self.store.is_complete(name, identity):
            return
        folder = self._compute(shard, scratch(), False)
        try:
            self.store.put_recorded(name, Path(folder.name, name), identity)
        finally:
            folder.cleanup()

    def _refuse_worker(self) -> None:
        """State why this worker cannot compute the shards."""
        there = stored_identity(self.store)
        if there is None:
            what = "the worker does not find it; a folder must be reached by the client and all workers"
        elif there.get("version") != _rins.VERSION:
            what = f"the client has rins {there.get('version')}, the worker {_rins.VERSION}"
        else:
            what = "the store was taken by another campaign"
        place = self.store.name(_IDENTITY)
        raise DistributedError(f"{place}: {what}", place)

    def _compute(self, shard: int, place: str | None, progress: Any) -> TemporaryDirectory[str]:
        """Compute a shard in a new temporary folder, which is removed on an error."""
        folder = TemporaryDirectory(prefix="rins-", dir=place)
        try:
            scenario = Path(folder.name, "scenario", self.name)
            scenario.parent.mkdir()
            scenario.write_bytes(self.scenario)
            monte_carlo(
                scenario,
                self.runs,
                Path(folder.name, self.part(shard)),
                seed=self.seed,
                shard=(shard, self.shards),
                threads=self.threads,
                progress=progress,
            )
        except RinsError as error:
            text = str(error).replace(f"{scenario.parent}/", "").replace(f"{folder.name}/", "")
            file = self.name if error.file == str(scenario) else error.file
            folder.cleanup()
            raise type(error)(text, file, error.line, error.key) from None
        except BaseException:
            folder.cleanup()
            raise
        return folder


def stored_identity(store: Store) -> dict[str, object] | None:
    """The identity of the campaign whose shards a store holds; None if it holds none."""
    content = store.read(_IDENTITY)
    if content is None:
        return None
    try:
        there = json.loads(content)
    except ValueError:
        there = None
    return there if isinstance(there, dict) else {}


def usual_shards(store: Store, runs: int, threads: int) -> int:
    """The number of shards: that of the campaign in the store, otherwise four a thread, or as many as keep shards small."""
    with contextlib.suppress(OSError, ImportError, ValueError):
        there = (stored_identity(store) or {}).get("shards")
        if isinstance(there, int) and there > 0:
            return there
    return max(-(-runs // RUNS_OF_A_SHARD), min(4 * threads, -(-runs // _RUNS_OF_A_CHUNK)))


def scratch() -> str | None:
    """The folder of this worker, which Dask removes after the worker's death; None outside of a worker."""
    from distributed import get_worker

    try:
        folder: str = get_worker().local_directory
    except ValueError:
        return None
    return folder
