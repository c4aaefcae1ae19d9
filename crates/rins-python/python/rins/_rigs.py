"""Diagnoses of many rigs, with their results in a store."""

from __future__ import annotations

import contextlib
import json
import os
import posixpath
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from errno import ENOENT
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, cast

from . import _errors, _rins
from ._commands import diagnose
from ._errors import DataError, RinsError
from ._rig import read_rig
from ._shards import scratch
from ._store import Store, copy, digest_of, is_url
from ._tasks import DistributedError, Task

if TYPE_CHECKING:
    from . import schema

_MARK = "diagnoses.json"
"""The file with which a worker recognizes the store of the client."""

_NO_INPUTS = "cannot be read"
"""Instead of a digest, if an input cannot be read: such a result is never kept."""


@dataclass(frozen=True)
class Options:
    """The arguments of `rins.diagnose`; model files with their name and content."""

    model: str | tuple[str, bytes]
    hypothesis: tuple[str, bytes] | None
    transfer: bool
    noise: str
    bootstrap: int | None

    @property
    def identity(self) -> dict[str, object]:
        """What a diagnosis depends on beside its inputs."""
        model, hypothesis = self.model, self.hypothesis
        return {
            "model": model if isinstance(model, str) else digest_of(model[1]),
            "hypothesis": None if hypothesis is None else digest_of(hypothesis[1]),
            "transfer": self.transfer,
            "noise": self.noise,
            "bootstrap": self.bootstrap,
            "version": _rins.VERSION,
        }


class Diagnosis:
    """The diagnosis of one of many rigs, which is read from the store when it is needed.

    Attributes
    ----------
    rig : str
        The rig file, as it was given.
    file : str
        The path or URL of the result: the line that ``rins diagnose --json`` prints, or ``{"error": ...}``.
    """

    rig: str
    file: str

    def __init__(self, rig: str, store: Store, name: str, error: RinsError | None) -> None:
        self.rig, self.file = rig, store.name(name)
        self._store, self._name, self._error = store, name, error

    def _content(self) -> tuple[str, RinsError | None]:
        if self._error is not None:
            return "", self._error
        text = (self._store.read(self._name) or b"").decode()
        data = json.loads(text or '{"error": {"message": "the result is not in the store"}}')
        if set(data) != {"error"}:
            return text, None
        found = data["error"]
        kind = getattr(_errors, str(found.get("type")), DataError)
        self._error = kind(*(found.get(key) for key in ("message", "file", "line", "key")))
        return "", self._error

    @property
    def error(self) -> RinsError | None:
        """The reason why there is no diagnosis, with `file`, `line` and `key`; None if there is one."""
        return self._content()[1]

    def to_json(self) -> str:
        """The line that ``rins diagnose --json`` prints.

        Raises
        ------
        RinsError
            The `error`, if there is no diagnosis.
        """
        text, error = self._content()
        if error is not None:
            raise error
        return text

    @property
    def data(self) -> schema.DiagnoseResult:
        """The typed fields of the diagnosis, as `rins.DiagnoseResult.data`; raises the `error`, if there is none."""
        return cast("schema.DiagnoseResult", json.loads(self.to_json()))

    @property
    def verdict(self) -> str:
        """``adequate``, ``named``, ``ambiguous`` or ``unexplained``; raises the `error`, if there is none."""
        return self.data["verdict"]

    def __repr__(self) -> str:
        return f"Diagnosis({self.rig!r}, {self.file!r})"


@dataclass(frozen=True)
class Inputs:
    """A rig file and the files of its log, which lie where its paths lead from it."""

    rig: Path
    files: Mapping[str, Path]
    """By the path in the rig file."""

    @classmethod
    def in_place(cls, rig: Path) -> Inputs:
        """Those of a rig file on this machine."""
        paths = _paths(rig.read_bytes())
        return cls(rig, {path: Path(os.path.normpath(rig.parent / path)) for path in paths})

    @classmethod
    def downloaded(cls, system: Any, rig: str, folder: Path) -> Inputs:
        """Those of a rig file in a file system of fsspec, copied into `folder`."""
        text = _read_from(system, rig)
        paths = _paths(text)
        tail = _tail(paths)
        local = cls(
            folder / tail / posixpath.basename(rig),
            {path: folder / posixpath.normpath(tail + path) for path in paths},
        )
        for path, target in local.files.items():
            if not os.path.isabs(path):
                target.parent.mkdir(parents=True, exist_ok=True)
                source = posixpath.normpath(posixpath.join(posixpath.dirname(rig), path))
                _ensure_there(system, source)
                system.get_file(source, str(target))
        local.rig.parent.mkdir(parents=True, exist_ok=True)
        local.rig.write_bytes(text)
        return local

    def digest(self) -> str:
        """The SHA-256 of the SHA-256 of all files."""
        of_each = {"": _digest_of_file(self.rig)}
        of_each.update((path, _digest_of_file(file)) for path, file in self.files.items())
        return digest_of(json.dumps(of_each, sort_keys=True).encode())

    def upload(self, store: Store, folder: str) -> str:
        """Copy the files to a folder of a store; the name of the rig file there."""
        tail = _tail(self.files)
        for path, file in self.files.items():
            if not os.path.isabs(path):
                store.put(f"{folder}/{posixpath.normpath(tail + path)}", file)
        rig = f"{folder}/{tail}{self.rig.name}"
        store.put(rig, self.rig)
        return rig


def _ensure_there(system: Any, path: str) -> None:
    """Raise `FileNotFoundError` with the URL of a file that does not exist: those of file systems differ."""
    if not system.exists(path):
        raise FileNotFoundError(ENOENT, os.strerror(ENOENT), system.unstrip_protocol(path))


def _read_from(system: Any, path: str) -> bytes:
    _ensure_there(system, path)
    content: bytes = system.cat_file(path)
    return content


def _paths(text: bytes) -> list[str]:
    """The paths of the log files that a rig file names; none of a rig file that cannot be read."""
    try:
        log = tomllib.loads(text.decode()).get("log")
    except ValueError:
        return []

    def found(value: object) -> Iterator[str]:
        if isinstance(value, dict):
            for key, one in value.items():
                if key == "path" and isinstance(one, str):
                    yield one
                yield from found(one)

    return list(dict.fromkeys(found(log)))


def _tail(paths: Sequence[str] | Mapping[str, object]) -> str:
    """A folder in which a rig file's paths that begin with ``..`` do not lead out of the folder above."""
    ups = [posixpath.normpath(path).split("/").count("..") for path in paths]
    return "rig/" * max(ups, default=0)


def _digest_of_file(path: Path) -> str:
    with open(path, "rb") as file:
        return copy(file)


@dataclass(frozen=True)
class Order:
    """The diagnosis of one rig on a worker."""

    source: str
    """The path or URL from which the worker reads the rig file."""
    shown: str
    """The path or URL that results and errors name."""
    name: str
    """The name of the result in the store."""
    options: Options
    store: Store
    version: str

    def identity(self, inputs: str) -> dict[str, object]:
        return {**self.options.identity, "inputs": inputs}

    def run(self) -> None:
        """Diagnose the rig on this worker and put the result into the store, unless it is there."""
        if self.store.read(_MARK) is None:
            place = self.store.name(_MARK)
            what = "the worker does not find it; a folder must be reached by the client and all workers"
            raise DistributedError(f"{place}: {what}", place)
        if self.version != _rins.VERSION:
            what = f"the client has rins {self.version}, the worker {_rins.VERSION}"
            raise DistributedError(what)
        with TemporaryDirectory(prefix="rins-", dir=scratch()) as temporary:
            try:
                inputs = self._inputs(Path(temporary))
                digest = inputs.digest()
            except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
                self._put(_error_text(_unreadable(error, self.shown)), _NO_INPUTS)
                return
            if not self.store.is_complete(self.name, self.identity(digest)):
                self._put(self._diagnosed(inputs.rig, Path(temporary)), digest)

    def _inputs(self, folder: Path) -> Inputs:
        if not is_url(self.source):
            return Inputs.in_place(Path(self.source))
        from fsspec.core import split_protocol, url_to_fs

        is_alike = split_protocol(self.source)[0] == split_protocol(self.store.url)[0]
        system, rig = url_to_fs(self.source, **(self.store.options if is_alike else {}))
        return Inputs.downloaded(system, rig, folder)

    def _diagnosed(self, rig: Path, folder: Path) -> str:
        """The JSON of the diagnosis, or of its error, with the paths that the client knows."""
        names = {f"{rig.parent}/": _folder(self.shown)}

        def file(which: str, model: str | tuple[str, bytes]) -> str:
            if isinstance(model, str):
                return model
            path = folder / which / Path(model[0]).name
            path.parent.mkdir()
            path.write_bytes(model[1])
            names[f"{path.parent}/"] = _folder(model[0])
            return str(path)

        options = self.options
        model = file("model", options.model)
        hypothesis = options.hypothesis and file("hypothesis", options.hypothesis)

        def named(text: str, quoted: Callable[[str], str] = str) -> str:
            for here, there in names.items():
                text = text.replace(quoted(here), quoted(there))
            return text

        try:
            result = diagnose(
                rig,
                model,
                transfer=options.transfer,
                hypothesis=hypothesis,
                noise=options.noise,
                bootstrap=options.bootstrap,
            )
        except RinsError as error:
            place = None if error.file is None else named(error.file)
            return _error_text(type(error)(named(str(error)), place, error.line, error.key))
        return named(result.to_json(), lambda text: json.dumps(text, ensure_ascii=False)[1:-1])

    def _put(self, text: str, inputs: str) -> None:
        self.store.write_recorded(self.name, text.encode(), self.identity(inputs))


def _folder(path: str) -> str:
    """What stands before the name of a file in its path."""
    return path[: path.rfind("/") + 1]


def _unreadable(error: OSError, rig: str) -> DataError:
    """The error of a rig of which a file cannot be read."""
    file = error.filename if isinstance(error.filename, str) else rig
    return DataError(f"cannot read {file}: {error.strerror or error}", file)


def _error_text(error: RinsError) -> str:
    place = {"file": error.file, "line": error.line, "key": error.key}
    found = {"type": type(error).__name__, "message": str(error), **place}
    return json.dumps({"error": found}, ensure_ascii=False)


class Diagnoses:
    """The diagnoses of many rigs, as the client knows them."""

    def __init__(self, rigs: Sequence[str], options: Options, store: Store) -> None:
        self.rigs, self.options, self.store = rigs, options, store
        self.errors: dict[int, RinsError] = {}
        places = {}
        for number, rig in enumerate(rigs):
            place = rig if is_url(rig) else os.path.abspath(rig)
            if place in places:
                raise ValueError(f"rigs: {rig!r} is given twice")
            places[place] = number
        self.names = [_name(place) for place in places]

    def begin(self) -> None:
        """Make the store.

        Raises
        ------
        DataError
            If the store cannot be written.
        """
        try:
            self.store.write(_MARK, json.dumps({"version": _rins.VERSION}).encode())
        except (OSError, ValueError, ImportError) as error:
            place = self.store.url
            raise DataError(f"{place}: the store cannot be used: {error}", place) from error

    def tasks(self, upload: bool, skip: Callable[[], object]) -> Iterator[Task]:
        """The diagnoses that are not in the store; `skip` is called for each other one."""
        for number, (rig, name) in enumerate(zip(self.rigs, self.names, strict=True)):
            source: str | None = rig if is_url(rig) else os.path.abspath(rig)
            if upload and not is_url(rig):
                source = self._uploaded(number, rig, name)
            if source is None:
                skip()
                continue
            order = Order(source, rig, name, self.options, self.store, _rins.VERSION)
            yield Task(number, rig, order.run, ())

    def _uploaded(self, number: int, rig: str, name: str) -> str | None:
        """Upload the inputs of a diagnosis; None if it is in the store, or if an input cannot be read."""
        try:
            read_rig(rig)
            inputs = Inputs.in_place(Path(rig))
            identity = {**self.options.identity, "inputs": inputs.digest()}
        except RinsError as error:
            self.errors[number] = error
            return None
        except OSError as error:
            self.errors[number] = _unreadable(error, rig)
            return None
        if self.store.is_complete(name, identity):
            return None
        uploaded = inputs.upload(self.store, f"inputs/{name}")
        local = self.store.local(uploaded)
        return self.store.name(uploaded) if local is None else str(local)

    def end(self, number: int) -> None:
        """Remove what was uploaded for a diagnosis."""
        self.store.remove(f"inputs/{self.names[number]}")

    def fail(self, number: int, error: BaseException, what: str) -> None:
        """Keep the exception with which a diagnosis failed on the workers as its result."""
        rig = self.rigs[number]
        found = DistributedError(f"{rig}: {what}: {type(error).__name__}: {error}", rig)
        found.__cause__ = error
        self.errors[number] = found

    def results(self) -> list[Diagnosis]:
        """All diagnoses, in the order of the rigs."""
        with contextlib.suppress(OSError):
            self.store.remove("inputs")
        return [
            Diagnosis(rig, self.store, name, self.errors.get(number))
            for number, (rig, name) in enumerate(zip(self.rigs, self.names, strict=True))
        ]


def _name(place: str) -> str:
    """The name of a rig's result: that of the rig, readable, and a digest of its path."""
    folder, _, file = place.rpartition("/")
    readable = f"{folder.rpartition('/')[2]}-{file.removesuffix('.toml')}"
    return f"{re.sub('[^A-Za-z0-9._-]', '_', readable)[-60:]}-{digest_of(place.encode())[:12]}.json"
