"""Circolare 7/2019, C8.7.1: a local mechanism by kinematic analysis, and by computed motion."""

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from rockframe.arguments import checked_name
from rockframe.codes.check import (
    PeakResponse,
    peak_responses,
    read_motions,
    rigid_block_setting,
    scene_summary,
)
from rockframe.components import Block, Load
from rockframe.errors import ComponentError
from rockframe.measures import response_spectrum
from rockframe.motion import GroundMotion
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.simulation.system import System
from rockframe.suggestions import with_hints
from rockframe.suites import TargetSpectrum
from rockframe.system.rigid_ground import RigidGroundSetting
from rockframe.system.stack import RestrainedSetting
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
_AT_LEAST_ONE: Final = Condition("1 or more", lambda value: value >= 1.0)
LIMIT_STATES: Final = {"SLV": (0.40, 1.68, 0.08, "10"), "SLC": (0.60, 1.56, 0.10, "11")}
"""Share of d0, factor of the period over pi, damping ratio, and number of the formula."""
SLD: Final = "SLD"
"""The limit state of damage: the wall is at rest until its mechanism is activated."""
_SLD_DAMPING: Final = 0.05
_PERIOD_COUNT: Final = 80
_SHORTEST_PERIOD: Final = 0.2
"""Shortest period at which the spectra of motions are evaluated [s]."""


@with_hints()
def circolare_2019(
    system: Block | System,
    demand: TargetSpectrum | GroundMotion | Mapping[str, GroundMotion],
    *,
    confidence_factor: RatioLike = 1.35,
    limit_state: str = "SLV",
    elastic_period: QuantityLike | None = None,
    free_vibration: QuantityLike = "20 s",
) -> CodeCheck:
    """Check a wall against overturning by Circolare 7/2019, C8.7.1, and by its computed motion.

    The mechanism is overturning as a rigid block about an edge of the base. The block overturns
    away from a :class:`~rockframe.RearWall`, or without one to the weaker side. The control point
    is the centre of mass.

    Parameters
    ----------
    system : Block or System
        A :class:`~rockframe.Block` on level rigid ground, with a :class:`~rockframe.RearWall` or
        without. Overburden is a :class:`~rockframe.Load` with a `moving_mass` for each mass.
    demand : TargetSpectrum, GroundMotion, or mapping of str to GroundMotion
        Demand of the limit state at the wall's base. A spectrum, at a damping ratio of 5 %
        (SLD), 8 % (SLV) or 10 % (SLC), allows the kinematic check alone. Motions, such as a
        suite, allow for SLV and SLC the dynamic check as well.
    confidence_factor : float, optional
        FC: 1.35, 1.20 or 1.00 by the level of knowledge [1].
    limit_state : {"SLV", "SLC", "SLD"}, optional
        Limit state of the demand.
    elastic_period : str or Quantity, optional
        Elastic period T_0 of the wall before uplift, at which the spectrum is read. Required
        for the SLD, and for it only [s].
    free_vibration : str or Quantity, optional
        Duration for which the run goes on after the end of each motion, on still ground [s].

    Returns
    -------
    CodeCheck
        The numbers and verdicts. Its method ``report`` writes them as a page.

    Raises
    ------
    ComponentError
        If the scene is another one, the limit state is unknown, `elastic_period` is missing or
        not used, or the spectrum has another damping ratio or does not reach the period.
    UnitsError
        If FC is not dimensionless.

    Examples
    --------
    >>> import rockframe as rf
    >>> wall = rf.System(rf.Block(width="0.5 m", height="6 m", mass="5 t"), gravity="9.81 m/s^2")
    >>> spectrum = rf.TargetSpectrum.from_table(
    ...     ["0.1 s", "4 s"], ([2.0, 0.1], "m/s^2"), damping_ratio=0.08
    ... )
    >>> check = rf.codes.circolare_2019(wall, spectrum, confidence_factor=1)
    >>> round(check.value("T_SLV"), 6)
    2.383086
    """
    system = System(system) if isinstance(system, Block) else system
    setting = rigid_block_setting(system, _OWNER, allow_loads=True)
    confidence = to_ratio(
        confidence_factor,
        owner=_OWNER,
        name="confidence_factor",
        condition=_AT_LEAST_ONE,
        example="1.35",
    )
    checked_name(limit_state, (*LIMIT_STATES, SLD), owner=_OWNER, name="limit_state")
    to_si(free_vibration, TIME, owner=_OWNER, name="free_vibration", condition=POSITIVE)
    if (elastic_period is None) == (limit_state == SLD):
        msg = f"{_OWNER}: elastic_period goes with limit_state='SLD', for example '0.2 s'"
        raise ComponentError(msg)
    mechanism = _mechanism_of(system, setting)
    capacity = _capacity_lines(mechanism, confidence)
    values = {line.symbol: line.value for line in capacity}
    if elastic_period is not None:
        period_before_uplift = to_si(
            elastic_period, TIME, owner=_OWNER, name="elastic_period", condition=POSITIVE
        )
        return _check_damage(system, demand, capacity, values["a_0*"], period_before_uplift)
    _, _, damping, _ = LIMIT_STATES[limit_state]
    d_limit, period = values[f"d_{limit_state}"], values[f"T_{limit_state}"]
    motions: dict[str, GroundMotion] = {}
    if isinstance(demand, TargetSpectrum):
        required = (
            _spectral_acceleration(demand, period, damping) * period * period / (4.0 * math.pi**2)
        )
        words = "S_e(T, xi) T^2/(4 pi^2)"
    else:
        motions = read_motions(demand, _OWNER)
        required = _displacement_demand(motions, period, damping)
        words = "largest mean spectral displacement of the motions up to T"
    demand_line = CheckedLine(
        "d_demand", required, Unit.METRE, f"demand, {words}, xi = {100.0 * damping:g} %",
        "C8.7.1.12",
    )  # fmt: skip
    verdicts = [
        CheckedVerdict(
            f"kinematic, {limit_state}", required <= d_limit,
            f"demand {required:.4g} m, capacity {d_limit:.4g} m", "C8.7.1.2.1",
        )
    ]  # fmt: skip
    lines = {"Mechanism and capacity": capacity, "Demand in displacement": (demand_line,)}
    if motions:
        peaks = peak_responses(system, motions, free_vibration, mechanism.control_point)
        lines["Motion of the wall"], by_motion = _check_motion(
            peaks, mechanism.oscillator_ratio, values["d_0"], d_limit, limit_state
        )
        verdicts += by_motion
    title = "A rigid block that overturns, by kinematics" + (" and by its motion" * bool(motions))
    return CodeCheck(title, _CODE, lines, tuple(verdicts), _NOTES, scene_summary(system))


_NOTES: Final = (
    "interlocking with side walls, ties and crushing of the edge",
    "an elastic branch before the wall lifts; the capacity curve is straight",
)


def _check_damage(
    system: System,
    demand: TargetSpectrum | GroundMotion | Mapping[str, GroundMotion],
    capacity: tuple[CheckedLine, ...],
    activation: float,
    period: float,
) -> CodeCheck:
    """Check that the mechanism is not activated by the demand of the SLD."""
    if isinstance(demand, TargetSpectrum):
        required = _spectral_acceleration(demand, period, _SLD_DAMPING)
    else:
        motions = read_motions(demand, _OWNER)
        spectrum = response_spectrum(motions, ([period], "s"), _SLD_DAMPING)
        required = float(spectrum.pseudo_spectral_acceleration.mean())
    demand_lines = (
        CheckedLine("T_0", period, Unit.SECOND, "elastic period of the wall", "given"),
        CheckedLine("S_e(T_0)", required, Unit.METRE_PER_SECOND_SQUARED,
                    "demand in acceleration, xi = 5 %", "C8.7.1.9"),
    )  # fmt: skip
    verdict = CheckedVerdict(
        "kinematic, SLD", required <= activation,
        f"demand {required:.4g} m s^-2, activation {activation:.4g} m s^-2", "C8.7.1.8",
    )  # fmt: skip
    lines = {"Mechanism and capacity": capacity, "Demand in acceleration": demand_lines}
    title = "A rigid block that overturns, whether its mechanism is activated"
    return CodeCheck(title, _CODE, lines, (verdict,), _NOTES, scene_summary(system))


class _Mechanism(NamedTuple):
    """Weights that overturn together about an edge, and their places relative to it."""

    weights: tuple[float, ...]  # of the wall, and of the masses that it carries [N]
    arms: tuple[float, ...]  # horizontal distances of the weights from the edge [m]
    heights: tuple[float, ...]  # their heights above it [m]
    gravity: float
    edge: float  # place of the edge, to the right of the middle of the base [m]

    def moment(self, *distances: tuple[float, ...]) -> float:
        """Return the sum of the weights times their distances."""
        return math.fsum(map(math.prod, zip(self.weights, *distances, strict=True)))

    @property
    def centre_of_mass(self) -> tuple[float, float]:
        """Horizontal distance of the common centre of mass from the edge, and height [m]."""
        weight = self.moment()
        return self.moment(self.arms) / weight, self.moment(self.heights) / weight

    @property
    def control_point(self) -> tuple[float, float]:
        """Place of the common centre of mass, from the middle of the base [m]."""
        beside, above = self.centre_of_mass
        return self.edge - math.copysign(beside, self.edge), above

    @property
    def oscillator_ratio(self) -> float:
        """Displacement of the equivalent oscillator over that of the centre of mass [1]."""
        second_moment = self.moment(self.heights, self.heights)
        return second_moment / (self.centre_of_mass[1] * self.moment(self.heights))


def _mechanism_of(system: System, setting: RigidGroundSetting | RestrainedSetting) -> _Mechanism:
    """Return the mechanism of the wall and its loads about the edge over which it overturns."""
    angles, block = setting.overturning_angles, system.parts.block_si
    side = 1.0 if setting.overturning_rotations[0] > 0.0 and angles.right <= angles.left else -1.0
    carried = [link.si for link in system.parts.links if isinstance(link, Load)]
    places = [(block.eccentricity, block.centre_height), *(load.at for load in carried)]
    masses = [block.mass, *(load.moving_mass for load in carried)]
    return _Mechanism(
        tuple(mass * setting.gravity for mass in masses),
        tuple(0.5 * block.width - side * x for x, _ in places),
        tuple(y for _, y in places),
        setting.gravity,
        0.5 * side * block.width,
    )


def _capacity_lines(mechanism: _Mechanism, confidence: float) -> tuple[CheckedLine, ...]:
    """Return activation, capacity curve, and displacements and periods of the limit states."""
    heights, moment = mechanism.heights, mechanism.moment
    # virtual work of the weights in a virtual rotation of 1
    multiplier = moment(mechanism.arms) / moment(heights)
    mass_share = moment(heights) ** 2 / (moment() * moment(heights, heights))
    spectral = multiplier * mechanism.gravity / (mass_share * confidence)
    # displacement at which the centre of mass is vertically above the edge
    ultimate = mechanism.oscillator_ratio * mechanism.centre_of_mass[0]
    lines = [
        CheckedLine("alpha_0", multiplier, Unit.ONE, "activation multiplier, "
                    "sum(P d_Py)/sum((P + Q) d_PQx)", "C8.7.1.1"),
        CheckedLine("e*", mass_share, Unit.ONE, "share of the mass that takes part", "C8.7.1.5"),
        CheckedLine("FC", confidence, Unit.ONE, "confidence factor", "given"),
        CheckedLine("a_0*", spectral, Unit.METRE_PER_SECOND_SQUARED,
                    "acceleration of activation, alpha_0 g/(e* FC), also the capacity at the SLD",
                    "C8.7.1.3, C8.7.1.8"),
        CheckedLine("d_0", ultimate, Unit.METRE, "displacement at which the multiplier is zero, of "
                    "the equivalent oscillator", "C8.7.1.4"),
    ]  # fmt: skip
    for state, (part, times, _, number) in LIMIT_STATES.items():
        limit = part * ultimate
        acceleration = spectral * (1.0 - part)
        period = times * math.pi * math.sqrt(limit / acceleration)
        lines += [
            CheckedLine(f"d_{state}", limit, Unit.METRE, f"{100.0 * part:.0f} % of d_0",
                        "C8.7.1.2.1"),
            CheckedLine(f"a(d_{state})", acceleration, Unit.METRE_PER_SECOND_SQUARED,
                        "of the capacity curve, a_0* (1 - d/d_0)", "C8.7.1.3"),
            CheckedLine(f"T_{state}", period, Unit.SECOND,
                        f"equivalent period, {times:g} pi sqrt(d_{state}/a(d_{state}))",
                        f"C8.7.1.{number}"),
        ]  # fmt: skip
    return tuple(lines)


def _spectral_acceleration(spectrum: TargetSpectrum, period: float, damping: float) -> float:
    """Return the spectral acceleration at a period [m s^-2]."""
    if not math.isclose(spectrum.damping_ratio, damping, rel_tol=1e-9):
        msg = (
            f"{_OWNER}: the spectrum must be of a damping ratio of {damping:g}, got "
            f"{spectrum.damping_ratio:g}"
        )
        raise ComponentError(msg)
    return float(spectrum.at_seconds(np.array([period]), owner=_OWNER)[0])


def _displacement_demand(
    motions: Mapping[str, GroundMotion], period: float, damping: float
) -> float:
    """Return the largest mean spectral displacement of the motions, over periods up to one [m]."""
    periods = np.geomspace(min(_SHORTEST_PERIOD, 0.5 * period), period, _PERIOD_COUNT)
    displacements = response_spectrum(motions, (periods, "s"), damping).spectral_displacement
    return float(displacements.mean("motion").max())


def _check_motion(
    peaks: Mapping[str, PeakResponse], ratio: float, ultimate: float, limit: float, state: str
) -> tuple[tuple[CheckedLine, ...], list[CheckedVerdict]]:
    """Return the displacement of the equivalent oscillator under each motion, and the verdicts."""
    displacements = {
        label: ultimate if peak.overturned else ratio * peak.displacement
        for label, peak in peaks.items()
    }
    mean, clause = float(np.mean([*displacements.values()])), "C8.7.1.2.1.9"
    lines = [
        CheckedLine(
            f"d, {label}", displacements[label], Unit.METRE,
            "overturned" if peak.overturned else f"peak rotation {peak.rotation:.4g} rad", "run",
        )
        for label, peak in peaks.items()
    ]  # fmt: skip
    words = "of the largest displacements; overturned ones count d_0"
    lines.append(CheckedLine("mean of d", mean, Unit.METRE, words, clause))
    overturned = [label for label, peak in peaks.items() if peak.overturned]
    # without a wall, one that is eccentric may stand beyond d_0 on the side of its longer arm
    beyond = sum(displacement > ultimate for displacement in displacements.values())
    verdicts = [
        CheckedVerdict(
            "dynamic, no run beyond d_0", not (overturned or beyond),
            f"{len(overturned)} of {len(peaks)} overturned"
            + (f": {', '.join(overturned)}" if overturned else f", d_0 = {ultimate:.4g} m")
            + (f"; {beyond} beyond d_0 to the other side" if beyond else ""), clause,
        ),
        CheckedVerdict(
            f"dynamic, {state}", not (overturned or beyond) and mean <= limit,
            f"mean of the largest displacements {mean:.4g} m, capacity {limit:.4g} m", clause,
        ),
    ]  # fmt: skip
    return tuple(lines), verdicts
