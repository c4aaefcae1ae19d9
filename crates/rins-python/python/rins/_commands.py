"""The commands as functions."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from . import _rins
from ._progress import Report, listener
from ._recording import Recording, log_of
from ._result import (
    AllanResult,
    CalibrateResult,
    DiagnoseResult,
    InitResult,
    MissionResult,
    NavigateResult,
    ObserveResult,
    Result,
    SimulateResult,
)

if TYPE_CHECKING:
    from . import schema

Pathlike = str | PathLike[str]
Run = Recording | Pathlike
"""A recording, or the path of a rig file."""

Runs = Run | Sequence[Run]
"""One run, or several of one IMU."""


def _paths(paths: Pathlike | Sequence[Pathlike]) -> list[Pathlike]:
    if isinstance(paths, (str, PathLike)):
        return [fspath(paths)]
    return [fspath(path) for path in paths]


def _optional(path: Pathlike | None) -> str | None:
    return None if path is None else fspath(path)


def _logs(runs: Runs) -> list[_rins.Log]:
    single = isinstance(runs, (str, PathLike, Recording))
    several: list[Run] = [runs] if single else list(runs)  # type: ignore[list-item, arg-type]
    if not several:
        raise ValueError("runs: no run, expected at least one")
    keys = [id(one) if isinstance(one, Recording) else fspath(one) for one in several]
    for place, key in enumerate(keys):
        if key in keys[:place]:
            raise ValueError(f"runs: {several[place]!r} is given twice")
    return [log_of(one) for one in several]


def check(run: Run) -> Result[schema.CheckResult]:
    """Inspect a run: sampling rate, gaps, static intervals, gravity, Earth rate, probable errors of units, signs and axes.

    Parameters
    ----------
    run : Recording or path-like
        The run, or its rig file.

    Returns
    -------
    Result
        ``verdicts`` are the checks; `Result.failure` states the defect if the run cannot be used.

    Raises
    ------
    DataError
        If the log cannot be read.
    """
    return Result(_rins.check(log_of(run)))


def allan(run: Run) -> AllanResult:
    """Estimate the noise parameters from a static interval, with Allan deviations and their 95 % confidence bounds.

    Parameters
    ----------
    run : Recording or path-like
        The run, or its rig file, whose log may lack sensors.

    Raises
    ------
    DataError
        If there is no static interval of sufficient length.
    """
    return AllanResult(_rins.allan(log_of(run, partial=True)))


def align(run: Run) -> Result[schema.AlignResult]:
    """Align over a static interval: level from gravity, north from the Earth's rotation.

    Parameters
    ----------
    run : Recording or path-like
        The run, or its rig file.

    Raises
    ------
    DataError
        If there is no static interval.
    """
    return Result(_rins.align(log_of(run)))


def navigate(
    run: Run, *, calibration: Pathlike | None = None, extrapolate: bool = False
) -> NavigateResult:
    """Free inertial navigation from standstill, with or without a calibration.

    Parameters
    ----------
    run : Recording or path-like
        The run, or its rig file.
    calibration : path-like, optional
        A calibration file, with which the readings are compensated.
    extrapolate : bool
        Whether readings are compensated far outside the calibrated range of temperature.

    Returns
    -------
    NavigateResult
        ``runs`` has velocity [m/s], position error [m] and attitude error [deg] at the end.
    """
    return NavigateResult(_rins.navigate(log_of(run), _optional(calibration), extrapolate))


def calibrate(
    runs: Runs,
    model: str | PathLike[str] | None = None,
    *,
    noise: str = "likely",
    progress: bool | Report = False,
) -> CalibrateResult:
    """Estimate sensor errors from runs on the table, with navigation before and after compensation.

    Parameters
    ----------
    runs : Recording, path-like, or a sequence of these
        The runs of one IMU, or their rig files.
    model : {"paper12", "full"} or path-like, optional
        ``paper12``: three gyro errors by the filter of Nie et al. (2019). ``full``: biases, scale errors, misalignments and the
        attitude of the spin axis. Otherwise a model file. By default paper12 for one run with a table angle or rate and a known
        attitude of the axis, and full otherwise.
    noise : {"likely", "given"}
        Whether the noise parameters are estimated, or taken from the data sheet.
    progress : bool or callable
        True for a bar of tqdm, or a function of the stage, the number of parts done and the number of parts.

    Returns
    -------
    CalibrateResult
        ``x``, ``se``, ``cov``, ``names``, ``units``.

    Raises
    ------
    DataError
        If a file or the data are invalid.
    ModelError
        If the model file is invalid, or the model cannot be estimated from the data.
    """
    name = None if model is None else fspath(model)
    return CalibrateResult(_rins.calibrate(_logs(runs), name, noise, listener(progress)))


def diagnose(
    runs: Runs,
    model: str | PathLike[str] = "full",
    *,
    held_out: Run | None = None,
    transfer: bool = False,
    hypothesis: Pathlike | None = None,
    noise: str = "likely",
    bootstrap: int | None = None,
    progress: bool | Report = False,
) -> DiagnoseResult:
    """Identify unmodeled effects in runs, and measure the gain in predicting held-out data.

    Parameters
    ----------
    runs : Recording, path-like, or a sequence of these
        The runs of one IMU, or their rig files.
    model : "full" or path-like
        The model, or a model file.
    held_out : Recording or path-like, optional
        The run on which the predictive gain is measured; by default the last 30 % of every segment.
    transfer : bool
        Whether the gain is also measured at the fastest rate, with estimates from the slower rates.
    hypothesis : path-like, optional
        A model file whose effects are evaluated instead of a search.
    noise : {"likely", "given"}
        Whether the noise parameters are estimated, or taken from the data sheet.
    bootstrap : int, optional
        The number of simulated runs from which the false alarm rate is estimated.
    progress : bool or callable
        As of `calibrate`.

    Returns
    -------
    DiagnoseResult
        ``verdict``, ``causes`` with ``effect``, ``p_value`` and ``parameters``.

    Raises
    ------
    DataError, ModelError
        As `calibrate`.
    """
    outcome = _rins.diagnose(
        _logs(runs),
        {
            "model": fspath(model),
            "held_out": None if held_out is None else log_of(held_out),
            "transfer": transfer,
            "hypothesis": _optional(hypothesis),
            "noise": noise,
            "bootstrap": bootstrap,
        },
        listener(progress),
    )
    return DiagnoseResult(outcome)


def demo(*, progress: bool | Report = False) -> Result[schema.DemoResult]:
    """Calibrate and diagnose the embedded run, with nothing to prepare; `Result.write` writes the run and its rig file too."""
    return Result(_rins.demo(listener(progress)))


def init(log: Pathlike, output: Pathlike | None = None) -> InitResult:
    """Draft a rig file from a log; guesses are marked to be confirmed.

    Parameters
    ----------
    log : path-like
        The log.
    output : path-like, optional
        Where the rig file will lie, for the path of the log in it. It is not written: `InitResult.text` is its content.
    """
    return InitResult(_rins.init(fspath(log), _optional(output)))


def simulate(scenario: Pathlike, *, seed: int | None = None) -> SimulateResult:
    """Simulate the run of a scenario file.

    Parameters
    ----------
    scenario : path-like
        The scenario: a rig file with a section ``[truth]``.
    seed : int, optional
        The seed of the random numbers; by default the scenario's.

    Returns
    -------
    SimulateResult
        `SimulateResult.recording` is the data set; `Result.write` writes ``run.csv``, ``rig.toml`` and ``truth.json``.
    """
    return SimulateResult(_rins.simulate(fspath(scenario), seed))


def convert(
    rig: Pathlike, output: Pathlike, *, format: str | None = None, force: bool = False
) -> Result[schema.ConvertResult]:
    """Write a log in another format, and a matching rig file.

    Parameters
    ----------
    rig : path-like
        The rig file.
    output : path-like
        The new log; its rig file has the same name with the extension ``.toml``.
    format : {"csv", "parquet", "mat", "psins", "psins-bin", "kf-gins", "euroc"}, optional
        By default the extension of `output` decides.
    force : bool
        Whether existing files are replaced.
    """
    return Result(_rins.convert(fspath(rig), fspath(output), format, force))


def apply(
    rig: Pathlike,
    calibration: Pathlike,
    output: Pathlike,
    *,
    format: str | None = None,
    extrapolate: bool = False,
    force: bool = False,
) -> Result[schema.ApplyResult]:
    """Write a log compensated by a calibration, and a matching rig file.

    Parameters
    ----------
    rig, calibration : path-like
        The rig file and the calibration file.
    output, format, force
        As of `convert`.
    extrapolate : bool
        Whether readings are compensated far outside the calibrated range of temperature.
    """
    options: Any = {
        "calibration": fspath(calibration),
        "output": fspath(output),
        "format": format,
        "extrapolate": extrapolate,
        "force": force,
    }
    return Result(_rins.apply(fspath(rig), options))


def compare(before: Pathlike, after: Pathlike) -> Result[schema.CompareResult]:
    """Compare two calibration files of one IMU: differences in units of their standard uncertainty."""
    return Result(_rins.compare(fspath(before), fspath(after)))


def history(
    runs: Pathlike | Sequence[Pathlike],
    *,
    date: str | None = None,
    temperature: float | None = None,
    minutes_since_power_on: float | None = None,
    progress: bool | Report = False,
) -> Result[schema.HistoryResult]:
    """Test whether parameters are the same in several runs, name how they vary, and predict the next run.

    Parameters
    ----------
    runs : path-like or sequence of path-like
        Calibration files, rig files, or folders of these.
    date : str, optional
        The date of the run to be predicted, such as ``"2027-01-31T00:00:00Z"``.
    temperature : float, optional
        Its temperature [degC].
    minutes_since_power_on : float, optional
        Its time since power-on [min].
    progress : bool or callable
        As of `calibrate`.
    """
    outcome = _rins.history(
        _paths(runs),
        {
            "date": date,
            "temperature": temperature,
            "minutes_since_power_on": minutes_since_power_on,
        },
        listener(progress),
    )
    return Result(outcome)


def mission(
    file: Pathlike,
    *,
    calibration: Pathlike | None = None,
    runs: int | None = None,
    seed: int = 1,
    want: str | None = None,
    progress: bool | Report = False,
) -> MissionResult:
    """Predict the position error of a system after days in service, for several schemes of rotation.

    Parameters
    ----------
    file : path-like
        The mission file.
    calibration : path-like, optional
        A calibration file: the sensor errors that are left have its covariance.
    runs : int, optional
        Number of missions with drawn errors that are navigated by strapdown for each scheme.
    seed : int
        Seed of the drawn errors.
    want : str, optional
        A position error that is to be held, such as ``"1 nmi / 24 h"`` (TRMS).
    progress : bool or callable
        As of `calibrate`.
    """
    outcome = _rins.mission(
        fspath(file),
        {"calibration": _optional(calibration), "runs": runs, "seed": seed, "want": want},
        listener(progress),
    )
    return MissionResult(outcome)


def observe(
    scenarios: Pathlike | Sequence[Pathlike],
    *,
    model: str | None = None,
    compare: bool = False,
    separate: tuple[str, str] | None = None,
    want: tuple[str, str] | None = None,
    max_rate: str | None = None,
    max_acceleration: str | None = None,
    max_duration: str = "3600 s",
    directions: int = 3,
    progress: bool | Report = False,
) -> ObserveResult:
    """Predict the observability of parameters under a rotation schedule, and propose the schedule to run next.

    Parameters
    ----------
    scenarios : path-like or sequence of path-like
        The scenario files; without `compare` the runs of one schedule.
    model : str, optional
        ``"full"``, ``"paper12"``, ``"baseline"``, ``"all"`` or a model file.
    compare : bool
        Whether the scenarios are compared side by side; join files with ``+`` to treat them as one schedule.
    separate : (str, str), optional
        Two effects to be separated by the proposed schedule.
    want : (str, str), optional
        A parameter and its required sigma, such as ``("gyro.scale.z", "0.1 ppm")``.
    max_rate, max_acceleration, max_duration : str
        Limits of the table, such as ``"30 deg/s"``, ``"5 deg/s^2"``, ``"1 h"``.
    directions : int
        The maximum number of orientations of the spin axis, 1 to 3.
    progress : bool or callable
        As of `calibrate`.
    """
    outcome = _rins.observe(
        _paths(scenarios),
        {
            "model": model,
            "compare": compare,
            "separate": None if separate is None else list(separate),
            "want": want,
            "max_rate": max_rate,
            "max_acceleration": max_acceleration,
            "max_duration": max_duration,
            "directions": directions,
        },
        listener(progress),
    )
    return ObserveResult(outcome)


def design(
    scenarios: Pathlike | Sequence[Pathlike],
    goal: str,
    *,
    model: str | None = None,
    duration: str | None = None,
    max_rate: str | None = None,
    max_acceleration: str | None = None,
    directions: int = 3,
    tilts: Sequence[str] | None = None,
    mountings: Sequence[str] = (),
    service: Pathlike | None = None,
    progress: bool | Report = False,
) -> Result[schema.DesignResult]:
    """Compute the rotation schedule that a calibration gains most from.

    Parameters
    ----------
    scenarios : path-like or sequence of path-like
        The scenario files: IMU, site, table and given schedule.
    goal : str
        A parameter (``"gyro.scale.x"``), ``"position@24h"``, ``"D"`` or ``"A"``, or two effects (``"A/B"``).
    model : str, optional
        ``"full"``, ``"paper12"``, ``"baseline"``, ``"all"`` or a model file.
    duration : str, optional
        The duration of all runs together, such as ``"10 min"``; by default that of the scenarios.
    max_rate, max_acceleration : str, optional
        Limits of the table, such as ``"30 deg/s"``, ``"5 deg/s^2"``.
    directions : int
        The maximum number of orientations of the spin axis, 1 to 6.
    tilts : sequence of str, optional
        The tilts of the spin axis that the table allows, such as ``["0 deg", "45 deg"]``; by default any from 0 to 90 deg.
    mountings : sequence of str
        The axes of the IMU that can be mounted along the spin axis, such as ``["x", "y", "z"]``; by default that of the scenario.
    service : path-like, optional
        The mission file of the system in service, for a position error.
    progress : bool or callable
        As of `calibrate`.
    """
    outcome = _rins.design(
        _paths(scenarios),
        {
            "goal": goal,
            "model": model,
            "duration": duration,
            "max_rate": max_rate,
            "max_acceleration": max_acceleration,
            "directions": directions,
            "tilts": None if tilts is None else list(tilts),
            "mountings": list(mountings),
            "service": _optional(service),
        },
        listener(progress),
    )
    return Result(outcome)


def monte_carlo(
    scenario: Pathlike,
    runs: int,
    output: Pathlike,
    *,
    model: str | PathLike[str] = "paper12",
    noise: str = "likely",
    truth: str = "prior",
    seed: int | None = None,
    resume: bool = False,
    shard: tuple[int, int] | None = None,
    threads: int | None = None,
    force: bool = False,
    progress: bool | Report = False,
) -> Result[schema.CampaignResult]:
    """Simulate and calibrate a scenario many times to test the consistency of the covariances (NEES).

    Parameters
    ----------
    scenario : path-like
        The scenario file; it may define a parameter grid.
    runs : int
        The number of runs of each scenario.
    output : path-like
        The file of the results (Parquet); the report page lies beside it.
    model : str or path-like
        "paper12" (the paper's three parameters), "full" (biases, scale errors, misalignments,
        attitude of the axis), or a model file. Any other than "paper12" is estimated as by
        `calibrate`.
    noise : str
        Whether a model's noise parameters are estimated ("likely") or those of the data sheet
        ("given").
    truth : str
        Whether the true values of a model's parameters are drawn from their priors in each run
        ("prior"), which is simulation-based calibration, or are those of the scenario ("scenario").
    seed : int, optional
        The seed; by default the scenario's.
    resume : bool
        Whether an interrupted campaign is continued. Ctrl-C leaves what is done.
    shard : (int, int), optional
        Part i of n of the campaign, for `merge`.
    threads : int, optional
        The number of threads; by default one per core.
    force : bool
        Whether existing results are replaced.
    progress : bool or callable
        As of `calibrate`.
    """
    outcome = _rins.monte_carlo(
        fspath(scenario),
        {
            "runs": runs,
            "seed": seed,
            "model": fspath(model),
            "noise": noise,
            "truth": truth,
            "output": fspath(output),
            "resume": resume,
            "shard": shard,
            "threads": threads,
            "force": force,
        },
        listener(progress),
    )
    return Result(outcome)


def merge(
    parts: Pathlike | Sequence[Pathlike], output: Pathlike, *, force: bool = False
) -> Result[schema.CampaignResult]:
    """Merge the partial results of a Monte Carlo campaign."""
    return Result(_rins.merge(_paths(parts), fspath(output), force))
