from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Protocol, TypedDict, final

__all__ = [
    "LiveCalibration",
    "Log",
    "Outcome",
    "VERSION",
    "align",
    "allan",
    "apply",
    "blind_page",
    "blind_trials",
    "calibrate",
    "check",
    "check_rig",
    "command",
    "compare",
    "convert",
    "demo",
    "design",
    "diagnose",
    "history",
    "init",
    "merge",
    "mission",
    "monte_carlo",
    "navigate",
    "observe",
    "simulate",
    "table",
]

VERSION: str

_Path = str | PathLike[str]
_Report = Callable[[str, int | None, int | None], object]

class _ArrowStream(Protocol):
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    @property
    def column_names(self) -> list[str]: ...
    @property
    def num_rows(self) -> int: ...

@final
class Log:
    @staticmethod
    def open(path: _Path, partial: bool) -> Log: ...
    @staticmethod
    def of_arrays(rig: tuple[str, _Path], name: str, arrays: list[tuple[str, Any]]) -> Log: ...
    @staticmethod
    def of_stream(rig: tuple[str, _Path], name: str, data: object) -> Log: ...
    @property
    def name(self) -> str: ...
    @property
    def inputs(self) -> list[tuple[str, str]]: ...
    @property
    def repairs(self) -> list[str]: ...
    def compensated(self, calibration: _Path, extrapolate: bool) -> tuple[Log, list[str]]: ...
    def memory(self) -> list[tuple[str, int, Any]]: ...
    def table(self) -> _ArrowStream: ...
    def __len__(self) -> int: ...

@final
class Outcome:
    @property
    def text(self) -> str: ...
    @property
    def json(self) -> str: ...
    @property
    def failure(self) -> str | None: ...
    def page(self) -> str | None: ...
    def write(self, folder: _Path, force: bool) -> str | None: ...

class _Live(TypedDict):
    model: str
    duration: float | None
    start: float
    source: _Path | None
    checkpoint: _Path | None

@final
class LiveCalibration:
    def __new__(cls, rig: _Path, options: _Live) -> LiveCalibration: ...
    def feed(self, data: bytes) -> int: ...
    @property
    def time(self) -> float | None: ...
    @property
    def parameters(self) -> list[tuple[str, float, float, str, float, bool]] | None: ...
    def line(self) -> str: ...
    def write_checkpoint(self, path: _Path) -> bool: ...
    def end(self) -> Outcome: ...

class _Diagnose(TypedDict):
    model: str
    held_out: Log | None
    transfer: bool
    hypothesis: _Path | None
    noise: str
    bootstrap: int | None

class _Apply(TypedDict):
    calibration: _Path
    output: _Path
    format: str | None
    extrapolate: bool
    force: bool

class _Conditions(TypedDict):
    date: str | None
    temperature: float | None
    minutes_since_power_on: float | None

class _Mission(TypedDict):
    calibration: _Path | None
    runs: int | None
    seed: int
    want: str | None

class _Observe(TypedDict):
    model: str | None
    compare: bool
    separate: list[str] | None
    want: tuple[str, str] | None
    max_rate: str | None
    max_acceleration: str | None
    max_duration: str
    directions: int

class _Design(TypedDict):
    goal: str
    model: str | None
    duration: str | None
    max_rate: str | None
    max_acceleration: str | None
    directions: int
    tilts: list[str] | None
    mountings: list[str]
    service: _Path | None

class _Campaign(TypedDict):
    runs: int
    seed: int | None
    model: str
    noise: str
    truth: str
    output: _Path
    resume: bool
    shard: tuple[int, int] | None
    threads: int | None
    force: bool

class _BlindOptions(TypedDict):
    program: _Path
    population: str
    seed: int
    trials: int
    shard: tuple[int, int]
    threads: int
    journal: _Path

def blind_trials(options: _BlindOptions) -> None: ...
def blind_page(journals: list[_Path], merged: _Path, population: str) -> str: ...
def check_rig(text: str, path: str) -> None: ...
def table(columns: list[tuple[str, Sequence[object]]]) -> _ArrowStream: ...
def command(words: Sequence[str]) -> int: ...
def check(log: Log) -> Outcome: ...
def allan(log: Log) -> Outcome: ...
def align(log: Log) -> Outcome: ...
def navigate(log: Log, calibration: _Path | None, extrapolate: bool) -> Outcome: ...
def calibrate(
    logs: list[Log], model: str | None, noise: str, progress: _Report | None
) -> Outcome: ...
def diagnose(logs: list[Log], options: _Diagnose, progress: _Report | None) -> Outcome: ...
def demo(progress: _Report | None) -> Outcome: ...
def init(log: _Path, output: _Path | None) -> Outcome: ...
def simulate(scenario: _Path, seed: int | None) -> Outcome: ...
def convert(rig: _Path, output: _Path, format: str | None, force: bool) -> Outcome: ...
def apply(rig: _Path, options: _Apply) -> Outcome: ...
def compare(before: _Path, after: _Path) -> Outcome: ...
def history(runs: list[_Path], conditions: _Conditions, progress: _Report | None) -> Outcome: ...
def mission(file: _Path, options: _Mission, progress: _Report | None) -> Outcome: ...
def observe(scenarios: list[_Path], options: _Observe, progress: _Report | None) -> Outcome: ...
def design(scenarios: list[_Path], options: _Design, progress: _Report | None) -> Outcome: ...
def monte_carlo(scenario: _Path, options: _Campaign, progress: _Report | None) -> Outcome: ...
def merge(parts: list[_Path], output: _Path, force: bool) -> Outcome: ...
