"""Tasks on the workers of a Dask cluster: a bounded number at a time, each repeated if it fails or its worker dies."""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from ._errors import RinsError

if TYPE_CHECKING:
    from distributed import Client

_SECONDS_BETWEEN_COUNTS = 5.0
"""The time after which the threads of the cluster are counted again: a cluster may grow or lose workers."""

_LONGEST_DELAY = 60.0
"""The longest time before a task is repeated [s]."""


class DistributedError(RinsError):
    """A task failed on the workers more often than permitted, or the workers do not fit the client."""


@dataclass(frozen=True)
class Task:
    """A call on a worker, whose effect is a file in the store; its value is not used."""

    number: int
    label: str
    """What it is, for messages, such as "shard 3 of 40"."""
    call: Callable[..., object]
    arguments: tuple[object, ...]


# The methods of clients and futures have no types: inside of this module they are Any.


def threads_of(client: Any) -> int:
    """The number of threads of all workers, at least one."""
    threads: dict[str, int] = client.nthreads()
    return max(1, sum(threads.values()))


def ensure_synchronous(client: Client) -> None:
    """Refuse a client of a coroutine."""
    if client.asynchronous:
        raise ValueError("client: it is asynchronous, expected Client(..., asynchronous=False)")


def run_all(
    client: Client,
    tasks: Iterator[Task],
    *,
    name: str,
    retries: int,
    in_flight: int | None,
    done: Callable[[Task], object],
    failed: Callable[[Task, BaseException, int], object],
) -> None:
    """Run the tasks, of which the scheduler knows at most `in_flight` at a time.

    A task that fails is submitted again up to `retries` times, after 1 s, 2 s, 4 s, … A task whose worker dies is given to
    another worker by the scheduler; after as many deaths as its setting ``allowed-failures`` permits, this counts as one failure.
    `done` and `failed` are called in this thread, in the order in which tasks end; an exception of theirs ends the run.
    """
    run = _Run(client, f"{name}-{uuid4().hex[:8]}", retries)
    try:
        run.loop(tasks, in_flight, done, failed)
    finally:
        run.cancel()


class _Run:
    """The tasks that are on the cluster, and those that wait to be repeated."""

    def __init__(self, client: Any, name: str, retries: int) -> None:
        self.client, self.name, self.retries = client, name, retries
        self.ended: SimpleQueue[Any] = SimpleQueue()
        self.active: dict[Any, tuple[Any, Task, int]] = {}
        # Of each: the time at which it is due, its number, the task, and the number of its failures.
        self.waiting: list[tuple[float, int, Task, int]] = []
        self.counted = float("-inf")
        self.threads = 1

    def loop(
        self,
        tasks: Iterator[Task],
        in_flight: int | None,
        done: Callable[[Task], object],
        failed: Callable[[Task, BaseException, int], object],
    ) -> None:
        is_exhausted = False
        while True:
            while len(self.active) < (in_flight or self._usual_limit()):
                if self.waiting and self.waiting[0][0] <= time.monotonic():
                    _, _, task, failures = heapq.heappop(self.waiting)
                    self._submit(task, failures)
                    continue
                following = None if is_exhausted else next(tasks, None)
                if following is None:
                    is_exhausted = True
                    break
                self._submit(following, 0)
            if is_exhausted and not self.active and not self.waiting:
                return
            try:
                future = self.ended.get(timeout=0.25)
            except Empty:
                continue
            _, task, failures = self.active.pop(future.key)
            error = _error_of(future)
            # Before the next task is submitted, so that the scheduler never knows more.
            future.release()
            if error is None:
                done(task)
            elif failures < self.retries:
                due = time.monotonic() + min(2.0**failures, _LONGEST_DELAY)
                heapq.heappush(self.waiting, (due, task.number, task, failures + 1))
            else:
                failed(task, error, failures + 1)

    def _submit(self, task: Task, failures: int) -> None:
        # The first part of the key is the name of the group: one group for all tasks, however many there are.
        key = (self.name, task.number, failures)
        future = self.client.submit(task.call, *task.arguments, key=key, pure=False)
        self.active[future.key] = (future, task, failures)
        future.add_done_callback(self.ended.put)

    def _usual_limit(self) -> int:
        """Twice the number of threads: the next task is there when one ends, and few are lost with a worker."""
        now = time.monotonic()
        if now - self.counted > _SECONDS_BETWEEN_COUNTS:
            self.threads, self.counted = threads_of(self.client), now
        return max(2 * self.threads, 4)

    def cancel(self) -> None:
        futures = [future for future, _, _ in self.active.values()]
        if futures and self.client.status == "running":
            self.client.cancel(futures)


def _error_of(future: Any) -> BaseException | None:
    """The exception of a task that ended; None if it succeeded. Nothing is fetched from a worker, which may be dead."""
    if future.status == "finished":
        return None
    if future.status == "error":
        error: BaseException | None = future.exception()
        return error or DistributedError("it failed without an exception")
    return DistributedError(f"it was {future.status} by the scheduler")
