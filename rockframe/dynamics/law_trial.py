"""A trial of the law of a user's own base or link, before the run."""

import itertools
import math
from collections.abc import Callable, Sequence
from functools import partial
from numbers import Integral, Real
from typing import Any, Final

import numpy as np

from rockframe.case_arrays import CaseArray
from rockframe.dynamics.body import BaseLine
from rockframe.dynamics.events import SILENT, EventKind, LinkState
from rockframe.dynamics.links import GUARDS, LinkEvent, LinkNumbers, Stretch
from rockframe.dynamics.point_law import Point
from rockframe.errors import AssemblyError, short_repr

_EVENTS: Final = {SILENT, *map(int, EventKind)}
"""Kinds of events that a law may report."""
_STATES_TRIED: Final = 16
_FAST: Final = 1e9
"""Speed over the settlement at which any dashpot pulls more than its spring presses [s^-1]."""


class _Faults(list[str]):
    """What is wrong with a law."""

    def check(self, what: str, value: Any, kind: type = Real, least: float = -math.inf) -> None:
        """Add a fault if a value is no finite number of a kind, or too small."""
        if not (isinstance(value, kind) and least <= value and math.isfinite(value)):
            wanted = "whole number" if kind is Integral else "finite number"
            bound = f" from {least:g} up" if least > -math.inf else ""
            self.append(f"{what} must be a {wanted}{bound}, got {short_repr(value)}")

    def check_each(self, what: str, values: Any, count: int | None = None) -> None:
        """Add a fault if values are no tuple of finite numbers, or not as many as they should."""
        if not isinstance(values, tuple) or (count is not None and len(values) != count):
            wanted = "" if count is None else f"{count} "
            self.append(f"{what} must be a tuple of {wanted}numbers, got {short_repr(values)}")
            return
        for value in values:
            self.check(what, value)


def _try_law(law: Any, trial: Callable[[Any, str], _Faults]) -> list[str]:
    """Return the faults of a law: of its numbers and counts, then those that a trial finds."""
    name, faults = type(law).__name__, _Faults()
    for field, value in zip(law._fields, law, strict=True):
        if not isinstance(value, Real) or math.isnan(value):
            faults.append(f"{name}.{field} must be a number, got {short_repr(value)}")
    faults.check(f"{name}.variables", law.variables(), Integral, 0)
    faults.check(f"{name}.states", law.states(), Integral, 1)
    try:
        return list(dict.fromkeys(faults or trial(law, name)))
    except TypeError as problem:
        trace = problem.__traceback__
        if trace is None or trace.tb_next is None or trace.tb_next.tb_next is not None:
            raise  # in a line of a method; here its call itself failed
        return [f"{name}: {problem}"]


def check_point_law(
    law: Any, settlement: float, columns: Sequence[Any], scales: Sequence[float]
) -> None:
    """Refuse a user's own law of a point that fails at the settlement of a base.

    Its columns are those of two points, and its variables have the typical sizes `scales`.
    """
    if not hasattr(law, "return_rate"):
        raise AssemblyError([f"the law of a base must be a point_law, got {short_repr(law)}"])
    if any(isinstance(value, CaseArray) for value in (*law, settlement)):
        return
    level = BaseLine(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    point = Point(settlement, 0.0, 0.0, 0.0, settlement, 0.5, level)
    faults = _try_law(
        law, partial(_faults_at_point, point=point, columns=len(columns), scales=tuple(scales))
    )
    if faults:
        raise AssemblyError(faults)


def check_unloaded_level(law: Any, settlement: float) -> None:
    """Refuse a user's own law of a point whose unloaded level is below its settlement."""
    sunk = law.sunk(np.zeros(law.variables()))
    if not sunk < settlement:
        msg = (
            f"{type(law).__name__}.sunk must be less than the settlement at rest, {settlement:.6g} "
            f"m, before the start of a run, got {sunk:.6g}"
        )
        raise AssemblyError([msg])


def _faults_at_point(
    law: Any, name: str, point: Point, columns: int, scales: tuple[float, ...]
) -> _Faults:
    """Return the faults of what the methods of a point's law return."""
    faults, count = _Faults(), law.variables()
    own = np.zeros(count)
    faults.check(f"{name}.spring", law.spring(point, own))
    faults.check(f"{name}.energy", law.energy(point, own))
    for share in (1.0, 0.99, 1.01):  # statics take differences about the settlement
        beside = point._replace(
            pressed=share * point.settlement, rise=(1.0 - share) * point.settlement
        )
        what = f"{name}.force" if share == 1.0 else f"{name}.force at {share:g} of the settlement"
        faults.check(what, law.force(0, beside, own))
    faults.check(f"{name}.force_rate", law.force_rate(0, point, own))
    faults.check(f"{name}.power", law.power(0, point, own))
    faults.check(f"{name}.sunk", law.sunk(own))
    faults.check(f"{name}.return_rate", law.return_rate(), least=0.0)
    rising = point._replace(speed=-_FAST * point.settlement)
    if law.return_rate() == 0.0 and law.force(0, rising, own) < 0.0:
        faults.append(
            f"{name}.return_rate must be positive: a point that rises fast enough loses its force "
            "below the unloaded level, to which it then returns at a finite rate, as a spring "
            "beside a dashpot at their stiffness over their damping"
        )
    faults.check_each(f"{name}.rates", law.rates(0, point, own), count)
    faults.check_each(f"{name}.seen for {columns} columns", law.seen(0, point, own), columns // 2)
    faults.check_each(f"variable_scales of {name}", scales, count)
    if law.states() > 1:
        faults.check_each(f"{name}.guard", law.guard(0, point, own), 2)
    law.settle(0, point, own)
    faults.check_each(f"{name}.settle", tuple(own.tolist()), count)
    return faults


def law_faults(numbers: Any) -> list[str]:
    """Return the faults of what a user's own link gives as its law, tried without elongation."""
    if not isinstance(numbers, LinkNumbers):
        return [f"its method law must return LinkNumbers, got {short_repr(numbers)}"]
    if not hasattr(numbers.law, "with_numbers"):
        return [f"its law must be a link_law, got {short_repr(numbers.law)}"]
    faults = _Faults()
    faults.check("stiffness of LinkNumbers", numbers.stiffness, least=0.0)
    faults.check("damping of LinkNumbers", numbers.damping, least=0.0)
    return faults or _try_law(numbers.law, _faults_of_link)


def _faults_of_link(law: Any, name: str) -> _Faults:
    """Return the faults of what the methods of a link's law return."""
    faults, states = _Faults(), range(law.states())
    own, stretch = np.zeros(law.variables()), Stretch(0.0, 0.0, 0.0, 1.0, 0.0)
    start = law.starting(stretch, own)
    if start not in states or not isinstance(start, Integral):
        found = f"one of {len(states)} states, got {short_repr(start)}"
        return _Faults([f"{name}.starting must give {found}"])
    faults.check(f"{name}.force", law.force(start, stretch, own))
    faults.check(f"{name}.energy", law.energy(start, stretch, own))
    faults.check(f"{name}.power", law.power(start, stretch, own))
    rates = np.zeros(law.variables())
    law.rates(start, stretch, own, rates)
    faults.check_each(f"{name}.rates", tuple(rates.tolist()))
    tried = states[:_STATES_TRIED]
    for state, which in itertools.product(tried, range(GUARDS)):
        guard = law.guard(which, state, stretch, own)
        faults.check_each(f"{name}.guard", guard, 2)
        if guard == (1.0, 0.0):  # there is none
            continue
        event = law.switch(which, state, stretch, own.copy())
        if not isinstance(event, LinkEvent):
            faults.append(f"{name}.switch must return a LinkEvent, got {short_repr(event)}")
        elif event.state not in states or event.event not in _EVENTS:
            faults.append(f"{name}.switch gives an unknown state or event, {event}")
    shown_states = [law.shown(state) for state in tried]
    if not set(shown_states) <= set(LinkState):
        faults.append(
            f"{name}.shown gives unknown states of restrainers, {short_repr(shown_states)}"
        )
    return faults
