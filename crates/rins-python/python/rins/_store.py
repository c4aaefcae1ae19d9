"""Stores of results: a folder, or a URL that fsspec opens; files are put whole, with a record of their SHA-256."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any
from uuid import uuid4

_BLOCK = 1 << 20
"""The length of a block that is read at once [bytes]."""

_OBJECT_STORES = frozenset({"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az"})
"""Protocols with which an object appears when it is complete: a put is atomic, and a rename would be a copy."""


def digest_of(data: bytes) -> str:
    """The SHA-256 of `data` in hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def is_url(place: str) -> bool:
    """Whether `place` is a URL, not a path."""
    return "://" in place or "::" in place


def copy(source: Any, target: Any | None = None) -> str:
    """Copy an open file to another one, or only read it; the SHA-256 of its content."""
    digest = hashlib.sha256()
    while block := source.read(_BLOCK):
        digest.update(block)
        if target is not None:
            target.write(block)
    return digest.hexdigest()


@dataclass(frozen=True)
class Store:
    """A place for files that the client and all workers reach.

    Parameters
    ----------
    url : str
        An absolute path, or a URL that fsspec opens.
    options : mapping
        The arguments of fsspec's file system, such as credentials.
    """

    url: str
    options: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def at(cls, place: str | PathLike[str], options: Mapping[str, Any] | None) -> Store:
        """The store at a path, which may be relative, or a URL."""
        name = fspath(place)
        name = name.rstrip("/") if is_url(name) else os.path.abspath(name)
        return cls(name, dict(options or {}))

    def _open(self) -> tuple[Any, str]:
        """The file system and the path of the store in it."""
        from fsspec.core import url_to_fs

        system, root = url_to_fs(self.url, **self.options)
        return system, str(root)

    def name(self, name: str) -> str:
        """The path or the URL of a file, for messages and for users."""
        return f"{self.url}/{name}"

    def local(self, name: str) -> Path | None:
        """The path of a file in a store that is a folder; otherwise None."""
        system, root = self._open()
        return Path(root, name) if _is_local(system) else None

    def read(self, name: str) -> bytes | None:
        """The content of a file; None if there is none."""
        system, root = self._open()
        try:
            content: bytes = system.cat_file(f"{root}/{name}")
        except FileNotFoundError:
            return None
        return content

    def get(self, name: str, target: Path) -> str:
        """Copy a file to the path `target`; the SHA-256 of its content."""
        system, root = self._open()
        with system.open(f"{root}/{name}", "rb") as source, open(target, "wb") as file:
            return copy(source, file)

    def digest(self, name: str) -> str | None:
        """The SHA-256 of a file; None if there is none."""
        system, root = self._open()
        try:
            with system.open(f"{root}/{name}", "rb") as source:
                return copy(source)
        except FileNotFoundError:
            return None

    def write(self, name: str, content: bytes) -> None:
        """Write a file, whole or not at all."""

        def local(path: str) -> None:
            with open(path, "wb") as file:
                file.write(content)
                _synchronise(file)

        self._replace(name, local, lambda system, path: system.pipe_file(path, content))

    def put(self, name: str, source: Path) -> None:
        """Copy the file at the path `source` to the store, whole or not at all."""

        def local(path: str) -> None:
            with open(source, "rb") as original, open(path, "wb") as file:
                shutil.copyfileobj(original, file, _BLOCK)
                _synchronise(file)

        self._replace(name, local, lambda system, path: system.put_file(str(source), path))

    def remove(self, name: str) -> None:
        """Remove a file or a folder, if it exists."""
        system, root = self._open()
        with contextlib.suppress(FileNotFoundError):
            system.rm(f"{root}/{name}", recursive=True)

    def remove_unfinished(self) -> None:
        """Remove what writers that were killed have left behind; nobody may write at the same time."""
        system, root = self._open()
        if not _is_object_store(system):
            for path in system.glob(f"{root}/.*.tmp"):
                with contextlib.suppress(FileNotFoundError):
                    system.rm_file(path)

    def _replace(
        self, name: str, local: Callable[[str], None], remote: Callable[[Any, str], object]
    ) -> None:
        """Write a file under a temporary name, and rename it; an object store needs no temporary name."""
        system, root = self._open()
        final = f"{root}/{name}"
        if _is_object_store(system):
            remote(system, final)
            return
        folder, _, base = final.rpartition("/")
        temporary = f"{folder}/.{base}.{uuid4().hex}.tmp"
        system.makedirs(folder, exist_ok=True)
        try:
            if _is_local(system):
                local(temporary)
                os.replace(temporary, final)
                _synchronise_folder(folder)
            else:
                remote(system, temporary)
                system.mv(temporary, final)
        except BaseException:
            with contextlib.suppress(Exception):
                system.rm_file(temporary)
            raise

    # Files with a record.

    def put_recorded(self, name: str, source: Path, identity: Mapping[str, object]) -> None:
        """Put a file, then its record: the SHA-256 and the identity of what the file is the result of."""
        with open(source, "rb") as file:
            digest = copy(file)
        self.put(name, source)
        self._record(name, digest, identity)

    def write_recorded(self, name: str, content: bytes, identity: Mapping[str, object]) -> None:
        """As `put_recorded`, of a content in memory."""
        self.write(name, content)
        self._record(name, digest_of(content), identity)

    def _record(self, name: str, digest: str, identity: Mapping[str, object]) -> None:
        self.write(f"{name}.record", json.dumps({**identity, "sha256": digest}).encode())

    def recorded(self, name: str, identity: Mapping[str, object]) -> str | None:
        """The SHA-256 in the record of a file, if there is a record of this identity."""
        content = self.read(f"{name}.record")
        try:
            record = json.loads(content or b"null")
        except ValueError:
            return None
        if not isinstance(record, dict) or any(
            record.get(key) != value for key, value in identity.items()
        ):
            return None
        digest = record.get("sha256")
        return digest if isinstance(digest, str) else None

    def is_complete(self, name: str, identity: Mapping[str, object]) -> bool:
        """Whether a file is there, of this identity, and its content has the recorded SHA-256."""
        digest = self.recorded(name, identity)
        return digest is not None and self.digest(name) == digest


def _protocols(system: Any) -> set[str]:
    protocol = system.protocol
    return {protocol} if isinstance(protocol, str) else set(protocol)


def _is_local(system: Any) -> bool:
    return bool(_protocols(system) & {"file", "local"})


def _is_object_store(system: Any) -> bool:
    return bool(_protocols(system) & _OBJECT_STORES)


def _synchronise(file: Any) -> None:
    """Wait until an open file is on the disk: the record of a file must not outlive its content."""
    file.flush()
    os.fsync(file.fileno())


def _synchronise_folder(folder: str) -> None:
    """Wait until the names in a folder are on the disk, where the system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
