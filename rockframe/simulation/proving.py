"""Public functions that prove verdicts, based on the package proof."""

from dataclasses import dataclass
from typing import Final

from rockframe.arguments import checked_integer
from rockframe.components import InitialState
from rockframe.errors import ComponentError, short_repr
from rockframe.motion import GroundMotion
from rockframe.proof.verdict import Proof, Tolerances
from rockframe.simulation.plan import Plan, plan_run
from rockframe.simulation.run_proof import prove_run
from rockframe.simulation.system import System, system_hint
from rockframe.suggestions import with_hints
from rockframe.system.assembly import Assembly
from rockframe.units import ANGLE, POSITIVE, Condition, QuantityLike, RatioLike, to_ratio, to_si

_OWNER: Final = "prove"
_CRITICAL: Final = "prove_critical_scale"
_WIDTH: Final = Condition("from 1e-14 to 0.1", lambda value: 1e-14 <= value <= 0.1)
_DIVISION_POINTS: Final = (0.5, 0.25, 0.75, 0.4, 0.6, 0.1, 0.9)
"""Points that divide a bracket, as shares of it; the next one is tried if nothing is proved."""
_GROWTH: Final = 1.1
_MAX_SEARCH_STEPS: Final = 100
_TOLERANCE: Final = Condition("from 0 to 0.1", lambda value: 0.0 <= value <= 0.1)


@with_hints()
def prove(
    system: System,
    motion: GroundMotion | None = None,
    *,
    scale: RatioLike = 1.0,
    restitution_tolerance: RatioLike = 0.0,
    scale_tolerance: RatioLike = 0.0,
    angle_tolerance: QuantityLike = "0 rad",
    parts: int = 64,
    initial: InitialState | None = None,
) -> Proof:
    """Prove whether a block on rigid ground or on pads overturns under a record.

    Parameters
    ----------
    system : System
        A block on rigid ground, level or inclined, with ``rotation="finite"``; or on a
        :class:`TwoSpringSupport` on level ground, held at its centre or by contact state.
    motion : GroundMotion, optional
        With or without vertical component. For a pulse in closed form the proof holds for the
        polynomials by which runs represent it. The motion among the parts unless given.
    scale : float, optional
        Factor of both components, taken as exact [1].
    restitution_tolerance : float, optional
        The proof holds for all coefficients of restitution of either corner that differ from the
        given ones by no more than this [1].
    scale_tolerance : float, optional
        The proof also holds for all scales that differ by no more than this; only on rigid
        ground [1].
    angle_tolerance : str or Quantity, optional
        The proof also holds for all angles theta of either corner that differ by no more than
        this, with the same distance of the corner from the centre of mass, inertia and
        restitutions, and with theta as the overturning angle; only on rigid ground [rad].
    parts : int, optional
        Largest number of parts into which the set of all these numbers is divided if nothing
        can be decided for the whole set. Each part needs its own proof.
    initial : InitialState, optional
        Where the motion starts; at rest unless given.

    Returns
    -------
    Proof
        Its ``verdict`` is ``"safe for ever"``, if the ground stays still after the record;
        ``"overturns"``, between ``earliest`` and ``latest`` [s]; or ``"undecided"``, with the
        ``reason``, and with the shares of the decided parts if only some parts of a set are
        decided. Its text states what has been proved.

    Raises
    ------
    UnitsError
        An argument is no ratio.
    ComponentError
        `system` is not a System, or is a scene of another kind; rotation is small on rigid
        ground; or python-flint is not installed (``pip install rockframe[proof]``).
    AssemblyError
        As for :meth:`rockframe.System.simulate`.

    Notes
    -----
    Every real number that occurs is enclosed in a ball, from the first sample to the end
    (section "Proved verdicts" of the theory manual). The theorem is about the model whose numbers
    are the doubles of a run; it does not say how well the model describes the block.

    Examples
    --------
    >>> import numpy as np
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    >>> sine = 3.0 * np.sin(np.pi * np.linspace(0.0, 1.0, 101))
    >>> pulse = rf.GroundMotion.from_arrays((sine, "m/s^2"), "0.01 s")
    >>> rf.prove(system, pulse).verdict, rf.prove(system, pulse, scale=1.2).verdict
    ('safe for ever', 'overturns')
    """
    factor = to_ratio(scale, owner=_OWNER, name="scale", condition=POSITIVE, example="1.5")
    ratios = {"restitution_tolerance": restitution_tolerance, "scale_tolerance": scale_tolerance}
    restitution, factors = (
        to_ratio(value, owner=_OWNER, name=name, condition=_TOLERANCE)
        for name, value in ratios.items()
    )
    angle = to_si(
        angle_tolerance, ANGLE, owner=_OWNER, name="angle_tolerance", condition=_TOLERANCE
    )
    max_parts = checked_integer(parts, owner=_OWNER, name="parts", lowest=1)
    within = Tolerances(restitution, factors, angle, max_parts)
    assembly, plan = _plan_proof(system, motion, initial, _OWNER)
    return prove_run(assembly, plan, scale=factor, within=within, owner=_OWNER)


@dataclass(frozen=True)
class ProvedBracket:
    """Two scales of a motion: one proved safe for ever, the other proved to overturn the block.

    Parameters
    ----------
    safe, overturns : float
        The scales [1].
    undecided : int
        Number of scales tried at which nothing could be proved.
    """

    safe: float
    overturns: float
    undecided: int

    @property
    def width(self) -> float:
        """Difference of both scales, divided by the greater [1]."""
        return abs(self.overturns - self.safe) / max(self.overturns, self.safe)


@with_hints()
def prove_critical_scale(
    system: System,
    motion: GroundMotion | None = None,
    *,
    width: RatioLike = 1e-9,
    start: RatioLike = 1.0,
    initial: InitialState | None = None,
) -> ProvedBracket:
    """Enclose a scale of a record at which the verdict changes, with proofs on both sides.

    Parameters
    ----------
    system : System
        As for :func:`prove`.
    motion : GroundMotion, optional
        A record; the one among the parts unless given.
    width : float, optional
        Difference of both scales, divided by the greater, at which the search ends [1].
    start : float, optional
        Scale from which the search begins, in steps of a tenth: upwards for a scale that
        overturns, or downwards for a safe one [1].
    initial : InitialState, optional
        Where the motion starts; at rest unless given.

    Returns
    -------
    ProvedBracket
        ``safe``, ``overturns`` and ``width`` [1], and how many scales remained ``undecided``;
        wider than `width` if no scale in between can be decided.

    Raises
    ------
    UnitsError, ComponentError, AssemblyError
        As for :func:`prove`; or no scale with the other verdict was found.

    Notes
    -----
    Verdicts are not monotone in the scale: this brackets one change of the verdict, and there
    may be others at lower scales.

    Examples
    --------
    >>> import numpy as np
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="5 m", mass="10 t"))
    >>> sine = 3.0 * np.sin(np.pi * np.linspace(0.0, 1.0, 101))
    >>> pulse = rf.GroundMotion.from_arrays((sine, "m/s^2"), "0.01 s")
    >>> found = rf.prove_critical_scale(system, pulse, width=1e-3)
    >>> found.width < 1e-3, found.undecided
    (True, 0)
    """
    share = to_ratio(width, owner=_CRITICAL, name="width", condition=_WIDTH)
    scale = to_ratio(start, owner=_CRITICAL, name="start", condition=POSITIVE)
    assembly, plan = _plan_proof(system, motion, initial, _CRITICAL)
    undecided = 0

    def overturns(at: float) -> bool | None:
        nonlocal undecided
        verdict = prove_run(assembly, plan, scale=at, owner=_CRITICAL).overturns
        undecided += verdict is None
        return verdict

    ends: dict[bool, float] = {}
    for _ in range(_MAX_SEARCH_STEPS):
        verdict = overturns(scale)
        if verdict is not None:
            ends[verdict] = scale
        if len(ends) == 2:
            break
        scale *= 1.0 / _GROWTH if True in ends else _GROWTH
    else:
        msg = f"{_CRITICAL}: no scale of another verdict was found up to {scale:.4g}; give a start"
        raise ComponentError(msg)
    while abs(ends[True] - ends[False]) > share * max(ends.values()):
        for place in _DIVISION_POINTS:
            scale = ends[False] + place * (ends[True] - ends[False])
            verdict = None if scale in ends.values() else overturns(scale)
            if verdict is not None:
                ends[verdict] = scale
                break
        else:
            break
    return ProvedBracket(ends[False], ends[True], undecided)


def _plan_proof(
    system: object, motion: GroundMotion | None, initial: InitialState | None, owner: str
) -> tuple[Assembly, Plan]:
    """Plan the run about which something is to be proved."""
    assembly = getattr(system, "assembly", None)
    if not isinstance(assembly, Assembly):
        msg = f"{owner}: system must be a System, got {short_repr(system)}{system_hint(system)}"
        raise ComponentError(msg)
    still = motion is None and assembly.parts.motion is None
    length = "1 s" if still else None
    return assembly, plan_run(assembly, motion, initial=initial, outputs=None, duration=length)
