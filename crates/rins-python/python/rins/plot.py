"""Plots of results with matplotlib, which must be installed (`pip install rins[plot]`). Each function returns the Axes."""

from __future__ import annotations

from collections import Counter
from math import log
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._result import (
        AllanResult,
        DiagnoseResult,
        EstimateResult,
        MissionResult,
        ObserveResult,
    )

__all__ = ["allan", "causes", "mission", "observability", "parameters"]


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained")[1]


def parameters(
    result: EstimateResult[Any], ax: Axes | None = None, *, unit: str | None = None
) -> Axes:
    """The estimates with their 3 sigma bars; a parameter that the data alone do not show is gray.

    Parameters
    ----------
    result : EstimateResult
        The calibration.
    ax : Axes, optional
        Where to draw; by default a new figure.
    unit : str, optional
        The parameters with this unit; by default the most frequent unit.

    Raises
    ------
    ValueError
        If no parameter has this unit.
    """
    units = Counter(result.units)
    unit = unit or units.most_common(1)[0][0]
    rows = zip(result.names, result.units, result.x, result.se, result.identified)
    shown = [row for row in rows if row[1] == unit]
    if not shown:
        raise ValueError(f"unit: {unit!r}, expected one of {list(units)}")
    ax = _axes(ax)
    for row, (_, _, value, sigma, is_identified) in enumerate(shown):
        color = "C0" if is_identified else "0.6"
        ax.errorbar(value, row, xerr=3.0 * sigma, fmt="o", color=color, capsize=3)
    ax.set_yticks(range(len(shown)), [one[0] for one in shown])
    ax.invert_yaxis()
    ax.axvline(0.0, color="0.8", zorder=0)
    ax.set_xlabel(f"estimate ± 3σ [{unit}]")
    ax.set_title(f"rins {result.data['command']}, model {result.data['model']}")
    return ax


def causes(result: DiagnoseResult, ax: Axes | None = None) -> Axes:
    """The evidence of each cause: the increase of the log-likelihood.

    Parameters
    ----------
    result : DiagnoseResult
        The diagnosis.
    ax : Axes, optional
        Where to draw; by default a new figure.
    """
    ax = _axes(ax)
    found = result.causes
    for row, cause in enumerate(found):
        ax.barh(row, cause["delta_log_likelihood"], height=0.5, color="C0")
        # The smallest p-values have no float.
        p = f"{cause['p_value']:.1g}" if cause["p_value"] else f"1e{cause['ln_p'] / log(10):.0f}"
        ax.annotate(f" p = {p}", (0.0, row), va="center", color="white")
    ax.set_yticks(range(len(found)), [cause["effect"] for cause in found])
    ax.set_ylim(max(len(found), 3) - 0.5, -0.5)
    ax.set_xlabel("increase of the log-likelihood [nat]")
    ax.set_title(f"rins diagnose: {result.verdict}")
    return ax


def allan(result: AllanResult, ax: Axes | None = None, *, sensor: str = "gyro") -> Axes:
    """The Allan deviations of a sensor's channels with their 95 % confidence bounds, and the fitted noise (dashed).

    Parameters
    ----------
    result : AllanResult
        The Allan deviations.
    ax : Axes, optional
        Where to draw; by default a new figure.
    sensor : {"gyro", "accel"}
        The sensor.
    """
    channels = [one for one in result.data["channels"] if one["channel"].startswith(sensor)]
    if not channels:
        raise ValueError(f"sensor: {sensor!r} has no channel, expected 'gyro' or 'accel'")
    ax = _axes(ax)
    for number, one in enumerate(channels):
        color = f"C{number}"
        ax.loglog(one["tau_s"], one["deviation"], "o-", color=color, label=one["channel"])
        ax.fill_between(one["tau_s"], one["low"], one["high"], color=color, alpha=0.2)
        ax.loglog(one["tau_s"], one["fitted"], "--", color=color)
    ax.set_xlabel("averaging time [s]")
    ax.set_ylabel(f"Allan deviation [{channels[0]['unit']}]")
    ax.legend()
    return ax


def observability(result: ObserveResult, ax: Axes | None = None) -> Axes:
    """The factor by which each schedule reduces the uncertainty of each parameter.

    Parameters
    ----------
    result : ObserveResult
        The study.
    ax : Axes, optional
        Where to draw; by default a new figure.
    """
    ax = _axes(ax)
    schedules = result.data["schedules"]
    height = 0.8 / len(schedules)
    for number, schedule in enumerate(schedules):
        rows = [row + height * number for row in range(len(schedule["parameters"]))]
        gains = [
            one["prior_sigma"] / one["sigma"] if one["prior_sigma"] and one["sigma"] else 1.0
            for one in schedule["parameters"]
        ]
        ax.barh(rows, gains, height=height, label=schedule["name"])
    names = [one["id"] for one in schedules[0]["parameters"]]
    ax.set_yticks(range(len(names)), names, fontsize="small")
    ax.invert_yaxis()
    ax.set_xscale("log")
    ax.set_xlabel("sigma before the run / sigma after it")
    ax.legend()
    return ax


def mission(result: MissionResult, ax: Axes | None = None, *, measure: str | None = None) -> Axes:
    """The position error of each scheme over time.

    Parameters
    ----------
    result : MissionResult
        The prediction.
    ax : Axes, optional
        Where to draw; by default a new figure.
    measure : {"trms_nmi", "cep50_nmi", "cep95_nmi", "east_nmi", "north_nmi"}, optional
        By default TRMS, if the mission file has a data sheet, and the error east otherwise.
    """
    schemes = result.data["schemes"]
    if measure is None:
        measure = "trms_nmi" if schemes[0].get("trms_nmi") else "east_nmi"
    ax = _axes(ax)
    for scheme in schemes:
        values: object = dict(scheme).get(measure)
        if not isinstance(values, list):
            raise ValueError(f"measure: {measure!r} is not in the result")
        ax.plot(scheme["hours"], values, label=scheme["name"])
    ax.set_xlabel("time [h]")
    ax.set_ylabel(f"{measure.removesuffix('_nmi')} [nmi]")
    ax.legend()
    return ax
