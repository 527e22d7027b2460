"""What a model needs of a base before a run: its law, stiffness, typical sizes and columns."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from rockframe.case_arrays import hypot, sqrt
from rockframe.compiled import Vector
from rockframe.dynamics.base import Base, equilibrium_height, positive_root
from rockframe.dynamics.bed import Bed, Rigid
from rockframe.dynamics.body import BaseLine, Body
from rockframe.dynamics.law_trial import check_point_law, check_unloaded_level
from rockframe.dynamics.pads import LEAVE, REENGAGE, ROUNDING, ElasticPads, Pads
from rockframe.dynamics.point_law import Point, Viscoelastic, point_at
from rockframe.dynamics.protocol import CORNER_REACTIONS, Column
from rockframe.dynamics.springs import GUARDS, Springs

_SETTLED: Final = 1e-9
"""Excess of the force of a law over the weight up to which a settlement is that of the law [1]."""


@dataclass(frozen=True)
class BaseNumbers:
    """A base under a body, per unit mass.

    Parameters
    ----------
    law : Base
        Its equations.
    columns : tuple of Column
        The columns of the results that it fills.
    settlement : float
        Settlement under the weight [m].
    vertical_stiffness, rotational_stiffness : float
        Stiffness in full contact, at the middle of the base [s^-2], [m^2 s^-2].
    damping_time : float
        Upper bound of damping over stiffness [s].
    end_tolerance : ndarray, shape (guards of an end,)
        Rounding noise of the guards.
    variable_scales : ndarray, shape (variables,)
        Typical sizes of the base's own variables.
    """

    law: Base
    columns: tuple[Column, ...]
    settlement: float
    vertical_stiffness: float
    rotational_stiffness: float
    damping_time: float
    end_tolerance: Vector
    variable_scales: Vector = field(default_factory=lambda: np.zeros(0))


def pads_numbers(
    body: Body,
    *,
    stiffness: float,  # k and c of one pad over the reference mass of the model [s^-2], [s^-1]
    damping: float,
    restitution: tuple[float, float],  # eps of a corner that lands, on the left, on the right pad
    load: float = 1.0,  # mass on the pads over the reference mass
) -> BaseNumbers:
    """Return the pads under a body."""
    rest = 0.5 * load * body.gravity / stiffness
    size = hypot(0.5 * (body.left + body.right), body.height)
    noise = ROUNDING * (1.0 + size / rest)
    law = ElasticPads(
        Viscoelastic(stiffness, damping),
        rest,
        0.5 * stiffness * rest * rest,
        sqrt(2.0 * stiffness),
        2.0 * body.gravity * noise / damping if damping > 0.0 else 0.0,
        *restitution,
        gravity=body.gravity,
        noise=noise,
    )
    return BaseNumbers(
        law,
        CORNER_REACTIONS,
        settlement=rest,
        vertical_stiffness=2.0 * stiffness,
        rotational_stiffness=stiffness * (body.left**2 + body.right**2),
        damping_time=damping / stiffness,
        end_tolerance=np.array(
            [noise if k in (LEAVE, REENGAGE) else ROUNDING for k in range(law.end_guards())]
        ),
    )


def pads_over(
    law: Any,
    elastic: BaseNumbers,
    *,
    columns: Sequence[Column] = (),
    variable_scales: Sequence[float] = (),
) -> BaseNumbers:
    """Return pads that follow another law.

    Parameters
    ----------
    law : PointLaw
        Law of each pad, per unit mass.
    elastic : BaseNumbers
        Elastic pads with the initial stiffness and damping of the law, by :func:`pads_numbers`. If
        its force does not carry the weight at their settlement, the settlement is computed from it.
    columns : sequence of Column, optional
        Columns of the results that the law fills, of the left pad, then of the right one.
    variable_scales : sequence of float, optional
        Typical sizes of the law's variables at one pad.
    """
    check_point_law(law, elastic.settlement, columns, variable_scales)
    check_unloaded_level(law, elastic.settlement)
    elastic = _settled(law, elastic)
    pads: Any = elastic.law
    guards = np.full(int(law.states() > 1), pads.noise)
    return replace(
        elastic,
        law=Pads(law, *pads[1:]),
        columns=(*elastic.columns, *columns),
        end_tolerance=np.concatenate([elastic.end_tolerance, guards]),
        variable_scales=np.tile(np.asarray(variable_scales, dtype=np.float64), 2),
    )


def _settled(law: Any, elastic: BaseNumbers) -> BaseNumbers:
    """Return elastic pads with the settlement, and the stiffness there, of another law."""
    pads: Any = elastic.law
    own, level = np.zeros(2 * law.variables()), BaseLine(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    carried = pads.law.stiffness * pads.rest
    at_rest = point_at(level, 0.5, pads.rest)
    if abs(law.force(0, at_rest, own) - carried) <= _SETTLED * carried:
        return elastic
    height = equilibrium_height(
        Pads(law, *pads[1:]), 2.0 * carried, 2.0 * pads.rest, (0.0, 0.0), own
    )
    rest = pads.rest - height
    check_unloaded_level(law, rest)
    at_rest = point_at(level, 0.5, rest)
    stiffness = law.force_rate(0, at_rest._replace(speed=1.0), own)
    share, noise = stiffness / pads.law.stiffness, pads.noise * max(1.0, pads.rest / rest)
    settled = pads._replace(
        rest=rest,
        rest_energy=law.energy(at_rest, own),
        frequency=sqrt(2.0 * stiffness),
        least=pads.least * noise / pads.noise,
        noise=noise,
    )
    return replace(
        elastic,
        law=settled,
        settlement=rest,
        vertical_stiffness=share * elastic.vertical_stiffness,
        rotational_stiffness=share * elastic.rotational_stiffness,
        damping_time=elastic.damping_time / share,
        end_tolerance=np.maximum(
            elastic.end_tolerance, np.where(elastic.end_tolerance == pads.noise, noise, 0.0)
        ),
    )


def springs_under(
    body: Body,
    law: Any,
    places: Sequence[float],
    lengths: Sequence[float],
    *,
    load: float = 1.0,
    columns: Sequence[Column] = (),
    variable_scales: Sequence[float] = (),
) -> BaseNumbers:
    """Return a bed of springs under a body.

    Parameters
    ----------
    body : Body
        The body on it.
    law : PointLaw
        Law of each spring, per unit length of base and unit mass.
    places : sequence of float
        Places of the springs, from left to right, as distances from the left end of the base over
        its width [1].
    lengths : sequence of float
        Tributary length of the base of each spring [m].
    load : float
        Mass on the bed over the reference mass of the model [1].
    columns : sequence of Column, optional
        Columns of the results that the law fills, of the leftmost, then of the rightmost spring.
    variable_scales : sequence of float, optional
        Typical sizes of the law's variables at one spring.
    """
    check_point_law(law, 1.0, columns, variable_scales)
    weight, width = load * body.gravity, body.left + body.right
    count, of_law = len(places), law.variables()
    at_rest = BaseLine(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def point(pressed: float, speed: float) -> Point:
        return Point(pressed, speed, 0.0, 0.0, pressed, 0.5, at_rest)

    def force(pressed: float, speed: float = 0.0) -> float:
        return float(law.force(0, point(pressed, speed), np.zeros(of_law)))

    pressure = weight / math.fsum(lengths)
    at_a_metre, name = force(1.0), type(law).__name__
    start = pressure / at_a_metre if at_a_metre > 0.0 else 1.0
    settlement = positive_root(lambda depth: force(depth) - pressure, start, name)
    check_unloaded_level(law, settlement)
    stiffness = law.force_rate(0, point(settlement, 1.0), np.zeros(of_law))
    damping = force(settlement, 1.0) - force(settlement)
    levers = body.left - width * np.asarray(places)
    noise = ROUNDING * (1.0 + hypot(0.5 * width, body.height) / settlement)
    return BaseNumbers(
        Springs(
            law,
            tuple(map(float, places)),
            tuple(map(float, lengths)),
            settlement,
            law.energy(point(settlement, 0.0), np.zeros(of_law)),
            weight,
            pressure,
            idle_guards=(1.0,) * (GUARDS * (count - count // 2)),
            zero_rates=(0.0,) * (count * (1 + of_law)),
        ),
        (*_BED_COLUMNS, *columns),
        settlement=settlement,
        vertical_stiffness=stiffness * math.fsum(lengths),
        rotational_stiffness=stiffness * float(np.dot(lengths, levers**2)),
        damping_time=damping / stiffness,
        end_tolerance=np.full(GUARDS * (count - count // 2), noise),
        variable_scales=np.concatenate([np.ones(count), np.tile(variable_scales, count)]),
    )


_BED_COLUMNS: Final = (
    Column("soil_reaction", per_mass=True),
    Column("contact_length"),
    Column("toe_pressure", per_mass=True),
)


def bed_numbers(
    body: Body,
    *,
    stiffness: float,  # k0 and c0 per length of base, over the reference mass of the model
    damping: float,
    by_pressure: bool,  # whether the bed separates also where its pressure would be negative
    load: float = 1.0,  # mass on the bed over the reference mass
) -> BaseNumbers:
    """Return the bed under a body."""
    width = body.left + body.right
    settlement = load * body.gravity / (width * stiffness)
    size = hypot(0.5 * width, body.height)
    return BaseNumbers(
        Bed(stiffness, damping, settlement, width, by_pressure),
        _BED_COLUMNS,
        settlement=settlement,
        vertical_stiffness=width * stiffness,
        rotational_stiffness=stiffness * (body.left**3 + body.right**3) / 3.0,
        damping_time=damping / stiffness,
        end_tolerance=np.array([ROUNDING * (1.0 + size / settlement)]),
    )


def rigid_numbers(body: Body) -> BaseNumbers:
    """Return a rigid base under a body of a chain: it has no stiffness, its corners constraints."""
    width = body.left + body.right
    return BaseNumbers(
        Rigid(0.0, 0.0, 1.0, width, by_pressure=False),
        CORNER_REACTIONS,
        settlement=0.0,
        vertical_stiffness=0.0,
        rotational_stiffness=0.0,
        damping_time=0.0,
        end_tolerance=np.array([ROUNDING]),
    )
