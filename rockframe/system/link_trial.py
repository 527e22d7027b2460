"""A trial of the law of a user's own link, before the run."""

import itertools
import math
from numbers import Integral, Real
from typing import Any, Final

import numpy as np

from rockframe.dynamics.events import SILENT, EventKind, LinkState
from rockframe.dynamics.links import GUARDS, LinkEvent, LinkNumbers, Stretch
from rockframe.errors import short_repr

_EVENTS: Final = {SILENT, *map(int, EventKind)}
"""Kinds of events that a law may report."""
_STATES_TRIED: Final = 16


class _Faults(list[str]):
    """What is wrong with a law."""

    def check(self, what: str, value: Any, kind: type = Real, least: float = -math.inf) -> None:
        """Add a fault if a value is no finite number of a kind, or too small."""
        if not (isinstance(value, kind) and least <= value and math.isfinite(value)):
            wanted = "whole number" if kind is Integral else "finite number"
            bound = f" from {least:g} up" if least > -math.inf else ""
            self.append(f"{what} must be a {wanted}{bound}, got {short_repr(value)}")


def law_faults(numbers: Any) -> list[str]:
    """Return the faults of what a user's own link gives as its law, tried without elongation."""
    if not isinstance(numbers, LinkNumbers):
        return [f"its method law must return LinkNumbers, got {short_repr(numbers)}"]
    law, faults = numbers.law, _Faults()
    if not hasattr(law, "with_numbers"):
        return [f"its law must be a link_law, got {short_repr(law)}"]
    name = type(law).__name__
    for field, value in zip(law._fields, law, strict=True):
        if not isinstance(value, Real) or math.isnan(value):
            faults.append(f"{name}.{field} must be a number, got {short_repr(value)}")
    faults.check("stiffness of LinkNumbers", numbers.stiffness, least=0.0)
    faults.check("damping of LinkNumbers", numbers.damping, least=0.0)
    faults.check(f"{name}.variables", law.variables(), Integral, 0)
    faults.check(f"{name}.states", law.states(), Integral, 1)
    try:
        return faults or _faults_of_methods(law, name)
    except TypeError as problem:
        trace = problem.__traceback__
        if trace is None or trace.tb_next is None or trace.tb_next.tb_next is not None:
            raise  # in a line of a method; here its call itself failed
        return [f"{name}: {problem}"]


def _faults_of_methods(law: Any, name: str) -> list[str]:
    """Return the faults of what the methods of a law return."""
    faults, states = _Faults(), range(law.states())
    own, stretch = np.zeros(law.variables()), Stretch(0.0, 0.0, 0.0, 1.0, 0.0)
    start = law.starting(stretch, own)
    if start not in states or not isinstance(start, Integral):
        return [f"{name}.starting must give one of {len(states)} states, got {short_repr(start)}"]
    faults.check(f"{name}.force", law.force(start, stretch, own))
    faults.check(f"{name}.energy", law.energy(start, stretch, own))
    faults.check(f"{name}.power", law.power(start, stretch, own))
    rates = np.zeros(law.variables())
    law.rates(start, stretch, own, rates)
    for rate in rates.tolist():
        faults.check(f"{name}.rates", rate)
    tried = states[:_STATES_TRIED]
    for state, which in itertools.product(tried, range(GUARDS)):
        guard = law.guard(which, state, stretch, own)
        if not isinstance(guard, tuple) or len(guard) != 2:
            faults.append(f"{name}.guard must return two numbers, got {short_repr(guard)}")
            continue
        for value in guard:
            faults.check(f"{name}.guard", value)
        if guard == (1.0, 0.0):  # there is none
            continue
        event = law.switch(which, state, stretch, own.copy())
        if not isinstance(event, LinkEvent):
            faults.append(f"{name}.switch must return a LinkEvent, got {short_repr(event)}")
        elif event.state not in states or event.event not in _EVENTS:
            faults.append(f"{name}.switch gives an unknown state or event, {event}")
    shown = [law.shown(state) for state in tried]
    if not set(shown) <= set(LinkState):
        faults.append(f"{name}.shown gives unknown states of restrainers, {short_repr(shown)}")
    return list(dict.fromkeys(faults))
