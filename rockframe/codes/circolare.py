"""Circolare 7/2019, C8.7.1: a local mechanism by kinematics, and by its motion."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from rockframe.arguments import one_of_names
from rockframe.codes.check import peaks_of, read_motions, rocking_block, scene_words
from rockframe.errors import ComponentError
from rockframe.measures import response_spectrum
from rockframe.motion import GroundMotion
from rockframe.proposals import hinted
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.simulation.system import System
from rockframe.suites import TargetSpectrum
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.units import (
    POSITIVE,
    TIME,
    Condition,
    QuantityLike,
    RatioLike,
    Unit,
    to_ratio,
    to_si,
)

_OWNER: Final = "circolare_2019"
_CODE: Final = "Circolare C.S.LL.PP. 21 January 2019, n. 7, to the NTC 2018, C8.7.1"
_FACTOR: Final = Condition("1 or more", lambda value: value >= 1.0)
LIMIT_STATES: Final = {"SLV": (0.40, 1.68, 0.08, "10"), "SLC": (0.60, 1.56, 0.10, "11")}
"""Share of d0, factor of the period over pi, damping ratio, and number of the formula."""
_PERIODS: Final = 80
_SHORTEST: Final = 0.2
"""Of the periods at which the spectra of motions are looked at [s]."""


@hinted()
def circolare_2019(
    system: System,
    demand: TargetSpectrum | GroundMotion | Mapping[str, GroundMotion],
    *,
    confidence_factor: RatioLike = 1.35,
    limit_state: str = "SLV",
    free_vibration: QuantityLike = "20 s",
) -> CodeCheck:
    """Check a wall that overturns by Circolare 7/2019, C8.7.1: kinematics beside its motion.

    The mechanism is overturning as a rigid block about an edge of the base, away from a
    :class:`~rockframe.RearWall`, or else to the weaker side; the control point is the centre of
    mass.

    Parameters
    ----------
    system : System
        A :class:`~rockframe.Block` on level rigid ground, with a :class:`~rockframe.RearWall` or
        without.
    demand : TargetSpectrum, GroundMotion, or mapping of str to GroundMotion
        At the wall's base, of the limit state: a spectrum at its damping ratio, 8 % (SLV) or 10 %
        (SLC), for the check in displacement alone; or motions, such as a suite, for the dynamic
        alternative, too.
    confidence_factor : float, optional
        FC: 1.35, 1.20 or 1.00 by the level of knowledge [1].
    limit_state : {"SLV", "SLC"}, optional
        Which the demand belongs to.
    free_vibration : str or Quantity, optional
        Still ground after each motion [s].

    Returns
    -------
    CodeCheck
        With a ``report``.

    Raises
    ------
    ComponentError
        Another scene, an unknown limit state, or a spectrum of another damping ratio or not known
        at the period.
    UnitsError
        FC is no pure ratio.

    Examples
    --------
    >>> import rockframe as rf
    >>> wall = rf.System(rf.Block(width="0.5 m", height="6 m", mass="5 t"), gravity="9.81 m/s^2")
    >>> spectrum = rf.TargetSpectrum.from_table(
    ...     (["0.1 s", "4 s"]), ([2.0, 0.1], "m/s^2"), damping_ratio=0.08
    ... )
    >>> check = rf.codes.circolare_2019(wall, spectrum, confidence_factor=1)
    >>> round(check.value("T_SLV"), 6)
    2.383086
    """
    setting = rocking_block(system, _OWNER)
    factor = to_ratio(
        confidence_factor, owner=_OWNER, name="confidence_factor", condition=_FACTOR, example="1.35"
    )
    one_of_names(limit_state, LIMIT_STATES, owner=_OWNER, name="limit_state")
    to_si(free_vibration, TIME, owner=_OWNER, name="free_vibration", condition=POSITIVE)
    capacity = _capacity(setting, factor)
    values = {one.symbol: one.value for one in capacity}
    _, _, damping, _ = LIMIT_STATES[limit_state]
    d_limit, period = values[f"d_{limit_state}"], values[f"T_{limit_state}"]
    motions = None if isinstance(demand, TargetSpectrum) else read_motions(demand, _OWNER)
    if isinstance(demand, TargetSpectrum):
        needed, words = _of_spectrum(demand, period, damping), "S_e(T, xi) T^2/(4 pi^2)"
    else:
        needed = _of_motions(motions or {}, period, damping)
        words = "largest mean spectral displacement of the motions up to T"
    wanted = CheckedLine(
        "d_demand", needed, Unit.METRE, f"demand, {words}, xi = {100.0 * damping:g} %",
        "C8.7.1.12",
    )  # fmt: skip
    verdicts = [
        CheckedVerdict(
            f"kinematic, {limit_state}", needed <= d_limit,
            f"demand {needed:.4g} m, capacity {d_limit:.4g} m", "C8.7.1.2.1",
        )
    ]  # fmt: skip
    lines = {"Mechanism and capacity": capacity, "Demand in displacement": (wanted,)}
    if motions is not None:
        found = _dynamic(system, setting, motions, free_vibration)
        lines["Motion of the wall"] = found
        verdicts += _dynamic_verdicts(found, values["d_0"], d_limit, limit_state)
    notes = (
        "interlocking with side walls, ties, overburden and crushing of the edge",
        "an elastic branch before the wall lifts; the capacity curve is straight",
    )
    title = "A rigid block that overturns, by kinematics" + (" and by its motion" * bool(motions))
    return CodeCheck(title, _CODE, lines, tuple(verdicts), notes, scene_words(system))


def _outwards(setting: RigidGroundSetting) -> tuple[float, float]:
    """Give how far the centre of mass is from the edge, beside and above it [m]."""
    angles, body = setting.overturning_angles, setting.body
    to_right = setting.overturning_rotations[0] > 0.0 and angles.right <= angles.left
    return (body.right if to_right else body.left), body.centre_height


def _capacity(setting: RigidGroundSetting, factor: float) -> tuple[CheckedLine, ...]:
    """Give activation, capacity curve and the displacements and periods of limit states."""
    beside, above = _outwards(setting)
    weight, gravity = setting.body.mass * setting.gravity, setting.gravity
    # the virtual displacements of the centre of mass, by a rotation of one
    multiplier = (weight * beside) / (weight * above)
    share = (weight * above) ** 2 / (weight * (weight * above**2))
    spectral = multiplier * gravity / (share * factor)
    last = beside  # where the centre of mass stands above the edge
    lines = [
        CheckedLine("alpha_0", multiplier, Unit.ONE, "activation multiplier, "
                    "sum(P d_Py)/sum((P + Q) d_PQx)", "C8.7.1.1"),
        CheckedLine("e*", share, Unit.ONE, "share of the mass that takes part", "C8.7.1.5"),
        CheckedLine("FC", factor, Unit.ONE, "confidence factor", "given"),
        CheckedLine("a_0*", spectral, Unit.METRE_PER_SECOND_SQUARED,
                    "acceleration of activation, alpha_0 g/(e* FC), also the capacity at the SLD",
                    "C8.7.1.3, C8.7.1.8"),
        CheckedLine("d_0", last, Unit.METRE, "displacement of the centre of mass at which the "
                    "multiplier is zero; of the equivalent oscillator the same", "C8.7.1.4"),
    ]  # fmt: skip
    for state, (part, times, _, number) in LIMIT_STATES.items():
        limit = part * last
        there = spectral * (1.0 - part)
        period = times * math.pi * math.sqrt(limit / there)
        lines += [
            CheckedLine(f"d_{state}", limit, Unit.METRE, f"{100.0 * part:.0f} % of d_0",
                        "C8.7.1.2.1"),
            CheckedLine(f"a(d_{state})", there, Unit.METRE_PER_SECOND_SQUARED,
                        "of the capacity curve, a_0* (1 - d/d_0)", "C8.7.1.3"),
            CheckedLine(f"T_{state}", period, Unit.SECOND,
                        f"equivalent period, {times:g} pi sqrt(d_{state}/a(d_{state}))",
                        f"C8.7.1.{number}"),
        ]  # fmt: skip
    return tuple(lines)


def _of_spectrum(spectrum: TargetSpectrum, period: float, damping: float) -> float:
    """Give the spectral displacement at a period [m]."""
    if not math.isclose(spectrum.damping_ratio, damping, rel_tol=1e-9):
        msg = (
            f"{_OWNER}: the spectrum must be of a damping ratio of {damping:g}, got "
            f"{spectrum.damping_ratio:g}"
        )
        raise ComponentError(msg)
    ordinate = float(spectrum.at_seconds(np.array([period]), owner=_OWNER)[0])
    return ordinate * period * period / (4.0 * math.pi**2)


def _of_motions(motions: Mapping[str, GroundMotion], period: float, damping: float) -> float:
    """Give the largest of the mean spectral displacements up to a period [m]."""
    periods = np.geomspace(min(_SHORTEST, 0.5 * period), period, _PERIODS)
    found = response_spectrum(motions, (periods, "s"), damping).spectral_displacement
    return float(found.mean("motion").max())


def _dynamic(
    system: System,
    setting: RigidGroundSetting,
    motions: Mapping[str, GroundMotion],
    free_vibration: QuantityLike,
) -> tuple[CheckedLine, ...]:
    """Give the largest displacement of the centre of mass under each motion."""
    beside, above = _outwards(setting)
    radius, theta = math.hypot(beside, above), math.atan2(beside, above)
    lines: list[CheckedLine] = []
    for label, (peak, overturned) in peaks_of(system, motions, free_vibration).items():
        moved = radius * (math.sin(theta) - math.sin(theta - min(peak, theta)))
        words = "overturned" if overturned else f"peak rotation {peak:.4g} rad"
        moved = beside if overturned else moved
        lines.append(CheckedLine(f"d, {label}", moved, Unit.METRE, words, "run"))
    mean = float(np.mean([one.value for one in lines]))
    words = "of the largest displacements; overturned ones count d_0"
    return (*lines, CheckedLine("mean of d", mean, Unit.METRE, words, "C8.7.1.2.1.9"))


def _dynamic_verdicts(
    found: tuple[CheckedLine, ...], last: float, limit: float, state: str
) -> list[CheckedVerdict]:
    fallen = [one.symbol.removeprefix("d, ") for one in found[:-1] if one.words == "overturned"]
    mean, clause = found[-1].value, "C8.7.1.2.1.9"
    return [
        CheckedVerdict(
            "dynamic, no run beyond d_0", not fallen,
            f"{len(fallen)} of {len(found) - 1} overturned"
            + (f": {', '.join(fallen)}" if fallen else f", d_0 = {last:.4g} m"), clause,
        ),
        CheckedVerdict(
            f"dynamic, {state}", not fallen and mean <= limit,
            f"mean of the largest displacements {mean:.4g} m, capacity {limit:.4g} m", clause,
        ),
    ]  # fmt: skip
