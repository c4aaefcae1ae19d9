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
    deaths: int,
    done: Callable[[Task], object],
    failed: Callable[[Task, BaseException, str], object],
) -> None:
    """Run the tasks, of which the scheduler knows at most `in_flight` at a time.

    A task that fails is submitted again up to `retries` times, after 1 s, 2 s, 4 s, … A task whose worker dies is given to
    another worker by the scheduler; after as many deaths as its setting ``allowed-failures`` permits, it is submitted again, up to
    `deaths` deaths: most workers do not die of the task that they have. `done` and `failed` are called in this thread, in the order
    in which tasks end; an exception of theirs ends the run.
    """
    run = _Run(client, f"{name}-{uuid4().hex[:8]}", retries, deaths)
    try:
        run.loop(tasks, in_flight, done, failed)
    finally:
        run.cancel()


@dataclass
class _Attempts:
    """A task and what it has been through."""

    task: Task
    submitted: int = 0
    errors: int = 0
    deaths: int = 0


class _Run:
    """The tasks that are on the cluster, and those that wait to be repeated."""

    def __init__(self, client: Any, name: str, retries: int, deaths: int) -> None:
        self.client, self.name, self.retries, self.deaths = client, name, retries, deaths
        self.ended: SimpleQueue[Any] = SimpleQueue()
        self.active: dict[Any, tuple[Any, _Attempts]] = {}
        # Of each: the time at which it is due, its number, and the task.
        self.waiting: list[tuple[float, int, _Attempts]] = []
        self.counted = float("-inf")
        self.threads = 1

    def loop(
        self,
        tasks: Iterator[Task],
        in_flight: int | None,
        done: Callable[[Task], object],
        failed: Callable[[Task, BaseException, str], object],
    ) -> None:
        is_exhausted = False
        while True:
            while len(self.active) < (in_flight or self._usual_limit()):
                if self.waiting and self.waiting[0][0] <= time.monotonic():
                    self._submit(heapq.heappop(self.waiting)[2])
                    continue
                following = None if is_exhausted else next(tasks, None)
                if following is None:
                    is_exhausted = True
                    break
                self._submit(_Attempts(following))
            if is_exhausted and not self.active and not self.waiting:
                return
            try:
                future = self.ended.get(timeout=0.25)
            except Empty:
                continue
            _, attempts = self.active.pop(future.key)
            error = _error_of(future)
            # Before the next task is submitted, so that the scheduler never knows more.
            future.release()
            if error is None:
                done(attempts.task)
            elif (delay := self._delay(attempts, error)) is not None:
                due = time.monotonic() + delay
                heapq.heappush(self.waiting, (due, attempts.task.number, attempts))
            elif _deaths_of(error):
                failed(attempts.task, error, f"{attempts.deaths} workers died while they had it")
            else:
                times = "once" if attempts.errors == 1 else f"{attempts.errors} times"
                failed(attempts.task, error, f"failed {times}")

    def _delay(self, attempts: _Attempts, error: BaseException) -> float | None:
        """Count an error of a task; the time after which it is repeated [s], None if it is not."""
        if deaths := _deaths_of(error):
            attempts.deaths += deaths
            return 0.0 if attempts.deaths <= self.deaths else None
        attempts.errors += 1
        if attempts.errors > self.retries:
            return None
        return float(min(2.0 ** (attempts.errors - 1), _LONGEST_DELAY))

    def _submit(self, attempts: _Attempts) -> None:
        # The first part of the key is the name of the group: one group for all tasks, however many there are.
        task = attempts.task
        key = (self.name, task.number, attempts.submitted)
        attempts.submitted += 1
        future = self.client.submit(task.call, *task.arguments, key=key, pure=False)
        self.active[future.key] = (future, attempts)
        future.add_done_callback(self.ended.put)

    def _usual_limit(self) -> int:
        """Twice the number of threads: the next task is there when one ends, and few are lost with a worker."""
        now = time.monotonic()
        if now - self.counted > _SECONDS_BETWEEN_COUNTS:
            self.threads, self.counted = threads_of(self.client), now
        return max(2 * self.threads, 4)

    def cancel(self) -> None:
        futures = [future for future, _ in self.active.values()]
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


def _deaths_of(error: BaseException) -> int:
    """How many workers died before the scheduler gave a task up; zero if its error is another one."""
    from distributed import KilledWorker

    return error.allowed_failures + 1 if isinstance(error, KilledWorker) else 0
