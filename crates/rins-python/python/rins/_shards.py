"""Shards of campaigns and of blind trials in a store."""

from __future__ import annotations

import contextlib
import json
import os
import sysconfig
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import ClassVar

from . import _rins
from ._commands import monte_carlo
from ._errors import DataError, RinsError
from ._progress import Report
from ._store import Store, digest_of
from ._tasks import DistributedError, Task

_IDENTITY = "campaign.json"
"""The file in a store that states whose shards it holds."""

RUNS_OF_A_SHARD = (64, 10_000)
"""The least runs of a shard by default, which are computed together, and the most."""

TRIALS_OF_A_SHARD = (1, 10)
"""The least blind trials of a shard by default, and the most: some minutes."""


class _Prepared(Exception):
    """The first shard begins."""


@dataclass(frozen=True)
class Shards(ABC):
    """Work in shards, each of which is computed on a worker and put into a store as one file."""

    shards: int
    threads: int
    store: Store

    _suffix: ClassVar[str]

    @property
    @abstractmethod
    def subject(self) -> dict[str, object]:
        """What the results depend on."""

    @property
    def identity(self) -> dict[str, object]:
        """What the results depend on, their division into shards, and the version."""
        return {**self.subject, "shards": self.shards, "version": _rins.VERSION}

    @abstractmethod
    def compute(self, shard: int, folder: Path) -> None:
        """Compute a shard: its file in this folder."""

    def part(self, shard: int) -> str:
        """The name of the file of a shard in the store; names are of equal length, in the order of the shards."""
        return f"part-{shard:0{len(str(self.shards))}}{self._suffix}"

    def parts(self) -> Iterator[str]:
        """The names of all shards' files."""
        return (self.part(shard) for shard in range(1, self.shards + 1))

    def identity_of(self, shard: int) -> dict[str, object]:
        """The identity of a shard, for its record."""
        return {**self.identity, "shard": shard}

    def begin(self) -> None:
        """Claim the store for this work.

        Raises
        ------
        DataError
            If the store cannot be written, or holds other shards.
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

    def tasks(self) -> Iterator[Task]:
        """A task for each shard."""
        for shard in range(1, self.shards + 1):
            yield Task(shard, f"shard {shard} of {self.shards}", self.ensure_shard, (shard,))

    def ensure_shard(self, shard: int) -> None:
        """Compute a shard on this worker and put it into the store, unless it is there with its recorded SHA-256.

        It is idempotent: a shard that is computed twice takes the place of the first.
        """
        if stored_identity(self.store) != self.identity:
            self._refuse_worker()
        name, identity = self.part(shard), self.identity_of(shard)
        if self.store.is_complete(name, identity):
            return
        with TemporaryDirectory(prefix="rins-", dir=scratch()) as folder:
            self.compute(shard, Path(folder))
            self.store.put_recorded(name, Path(folder, name), identity)

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

    @contextlib.contextmanager
    def collected(self, place: Path) -> Iterator[list[Path]]:
        """The files of all shards: where they lie if the store is a folder, otherwise copies in a temporary folder in `place`.

        Raises
        ------
        DataError
            If a file is not the recorded one.
        """
        store = self.store
        folder = store.local("")
        if folder is not None:
            yield [folder / name for name in self.parts()]
            return
        with TemporaryDirectory(prefix=".rins-", dir=place) as temporary:
            parts = []
            for shard, name in enumerate(self.parts(), 1):
                parts.append(Path(temporary, name))
                if store.get(name, parts[-1]) != store.recorded(name, self.identity_of(shard)):
                    raise DataError(
                        f"{store.name(name)}: its SHA-256 is not the recorded one; call again to repeat this shard",
                        store.name(name),
                    )
            yield parts


@dataclass(frozen=True)
class ModelOption:
    """A model by its name, or a model file by its content: workers need not reach the file."""

    name: str
    content: bytes | None

    @property
    def identity(self) -> str:
        """The name, or the SHA-256 of the file."""
        return self.name if self.content is None else digest_of(self.content)

    def placed(self, folder: Path) -> str:
        """The model for `rins.monte_carlo`: its name, or the path of its file in `folder`."""
        if self.content is None:
            return self.name
        path = folder / Path(self.name).name
        path.write_bytes(self.content)
        return str(path)


@dataclass(frozen=True)
class Campaign(Shards):
    """The shards of a Monte Carlo campaign."""

    name: str
    """The name of the scenario file, for messages and for the worker's copy."""
    scenario: bytes
    """The content of the scenario file: workers need not reach the file."""
    runs: int
    seed: int | None
    model: ModelOption
    noise: str
    truth: str

    _suffix = ".parquet"

    @property
    def subject(self) -> dict[str, object]:
        return {
            "scenario_sha256": digest_of(self.scenario),
            "runs": self.runs,
            "seed": self.seed,
            "model": self.model.identity,
            "noise": self.noise,
            "truth": self.truth,
        }

    def check(self) -> None:
        """Prepare the first shard as a worker does: an error in the scenario or the arguments is raised before the campaign."""

        def stop(stage: str, done: int | None, total: int | None) -> None:
            raise _Prepared

        with TemporaryDirectory(prefix="rins-") as folder, contextlib.suppress(_Prepared):
            self._compute(1, Path(folder), stop)

    def compute(self, shard: int, folder: Path) -> None:
        self._compute(shard, folder, False)

    def _compute(self, shard: int, folder: Path, progress: bool | Report) -> None:
        inputs = {name: folder / name for name in ("scenario", "model")}
        for one in inputs.values():
            one.mkdir()
        scenario = inputs["scenario"] / self.name
        scenario.write_bytes(self.scenario)
        model = self.model.placed(inputs["model"])
        try:
            monte_carlo(
                scenario,
                self.runs,
                folder / self.part(shard),
                seed=self.seed,
                model=model,
                noise=self.noise,
                truth=self.truth,
                shard=(shard, self.shards),
                threads=self.threads,
                progress=progress,
            )
        except RinsError as error:
            text = str(error).replace(model, self.model.name)
            for one in (*inputs.values(), folder):
                text = text.replace(f"{one}/", "")
            names = {str(scenario): self.name, model: self.model.name}
            file = error.file and names.get(error.file, error.file)
            raise type(error)(text, file, error.line, error.key) from None


@dataclass(frozen=True)
class Trials(Shards):
    """The shards of blind trials of the diagnosis."""

    population: str
    trials: int
    seed: int

    _suffix = ".jsonl"

    @property
    def subject(self) -> dict[str, object]:
        return {"population": self.population, "trials": self.trials, "seed": self.seed}

    def compute(self, shard: int, folder: Path) -> None:
        _rins.blind_trials(
            {
                "program": command_path(),
                "population": self.population,
                "seed": self.seed,
                "trials": self.trials,
                "shard": (shard, self.shards),
                "threads": self.threads,
                "journal": folder / self.part(shard),
            }
        )


def command_path() -> Path:
    """The command `rins` of this environment.

    Raises
    ------
    DistributedError
        If there is none: the package is not installed as a wheel.
    """
    name = "rins.exe" if os.name == "nt" else "rins"
    path = Path(sysconfig.get_path("scripts"), name)
    if not path.exists():
        raise DistributedError(f"{path}: there is no such command; install the wheel of rins", str(path))
    return path


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


def usual_shards(store: Store, items: int, threads: int, limits: tuple[int, int]) -> int:
    """The number of shards: that of the campaign in the store, otherwise four a thread; `limits` are the least items of a shard
    that are worth one, and the most."""
    with contextlib.suppress(OSError, ImportError, ValueError):
        there = (stored_identity(store) or {}).get("shards")
        if isinstance(there, int) and there > 0:
            return there
    least, most = limits
    return max(-(-items // most), min(4 * threads, -(-items // least)))


def scratch() -> str | None:
    """The folder of this worker, which Dask removes after the worker's death; None outside of a worker."""
    from distributed import get_worker

    try:
        folder: str = get_worker().local_directory
    except ValueError:
        return None
    return folder
