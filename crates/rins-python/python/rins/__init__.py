"""Calibration and diagnosis of an IMU on a rate table.

Every command of `rins` is a function here. Runs are rig files or `Recording` objects made of arrays; results are `Result`
objects: the text of the command, its JSON, its typed fields, its report page.

>>> import rins
>>> res = rins.calibrate("rig.toml", model="full")  # doctest: +SKIP
>>> print(res.summary())  # doctest: +SKIP
"""

from __future__ import annotations

from ._commands import (
    align,
    allan,
    apply,
    calibrate,
    check,
    compare,
    convert,
    demo,
    design,
    diagnose,
    history,
    init,
    merge,
    mission,
    monte_carlo,
    navigate,
    observe,
    simulate,
)
from ._errors import DataError, ModelError, RinsError
from ._live import LiveCalibration
from ._recording import Recording
from ._result import (
    AllanResult,
    CalibrateResult,
    DiagnoseResult,
    EstimateResult,
    InitResult,
    LiveResult,
    MissionResult,
    NavigateResult,
    ObserveResult,
    Result,
    SimulateResult,
)
from ._rig import Rig, read_rig
from ._rins import VERSION as __version__
from ._table import Table

__all__ = [
    "AllanResult",
    "CalibrateResult",
    "DataError",
    "DiagnoseResult",
    "EstimateResult",
    "InitResult",
    "LiveCalibration",
    "LiveResult",
    "MissionResult",
    "ModelError",
    "NavigateResult",
    "ObserveResult",
    "Recording",
    "Result",
    "Rig",
    "RinsError",
    "SimulateResult",
    "Table",
    "__version__",
    "align",
    "allan",
    "apply",
    "calibrate",
    "check",
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
    "read_rig",
    "simulate",
]
