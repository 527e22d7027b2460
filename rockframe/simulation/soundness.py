"""Checks of a finished run that give reasons to doubt it.

Energies out of balance, a body that still moves at the end, and impacts on rigid bases after which
the motion is not unique.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rockframe.dynamics.chain.rigid import SET_MEMORY, RigidChain
from rockframe.dynamics.events import (
    OVERTURNING,
    REVERSAL,
    SEPARATION,
    SILENT,
    SLIP,
    STICK,
    TOPPLED,
    UPLIFT,
)
from rockframe.dynamics.protocol import ContactModel, Ending, Ground
from rockframe.simulation.certify.run_summary import RunSummary
from rockframe.simulation.plan import Plan
from rockframe.solve.accuracy import LEVELS, AccuracyLevel
from rockframe.solve.trajectory import Summary, Trajectory
from rockframe.system.assembly import Assembly

MAX_ADAPTIVE_RESIDUAL: Final = 1e-3
"""Energy residual beyond which steps by tolerance give no solution; sound runs are below 1e-5."""
MAX_FIXED_STEP_RESIDUAL: Final = 0.5
"""Energy residual beyond which fixed steps give no solution; their works on springs are less exact
than their motion."""
DOUBTFUL_RESIDUAL: Final = 1e-2
"""Energy residual of fixed steps beyond which the run is compared with one by tolerance."""
DOUBTFUL_RESIDUAL_ON_SPRINGS: Final = 0.04
"""This residual on a base that is not rigid, where works are less exact: of 40 000 random runs none
reached it, and runs with half of it were wrong no more often than runs without residual."""
PEAK_TOLERANCE: Final = 0.01
"""Relative difference up to which the peak rotation agrees with that of a run by tolerance."""

NEGLIGIBLE_PEAK: Final = 1e-4
"""Share of the overturning angle up to which a peak rotation is negligible for the verdict: the
energies of such small motion are no larger than the errors that a step may have."""


def doubtful_residual(system: Assembly) -> float:
    """Return the energy residual beyond which fixed steps are compared with steps by tolerance."""
    return DOUBTFUL_RESIDUAL if system.setting.settlement is None else DOUBTFUL_RESIDUAL_ON_SPRINGS


def energy_caution(
    system: Assembly,
    plan: Plan,
    summary: Summary,
    base: Callable[[], RunSummary],
    run: Callable[[Plan], RunSummary],
) -> str | None:
    """Warn if the energies of a run show that it is no solution; `run` makes another run."""
    residual, by_tolerance = summary.energy_residual, plan.accuracy.substeps is None
    if residual <= (MAX_ADAPTIVE_RESIDUAL if by_tolerance else doubtful_residual(system)):
        return None
    shown = base()
    if shown.overturned is None:
        return None
    negligible = shown.peak_share <= NEGLIGIBLE_PEAK
    if negligible and by_tolerance:
        return None
    found = f"the energies are out of balance by {residual:.2g} of the largest"
    if residual == math.inf:
        return "the energies of the scene are not all numbers, so that nothing checks its motion"
    if by_tolerance:
        return f"{found}: this is no solution; repeat the run with a tighter tolerance"
    remedy = f"repeat the run with accuracy='{AccuracyLevel.STANDARD}'"
    if residual > MAX_FIXED_STEP_RESIDUAL and not negligible:
        return f"{found}: this is no solution; {remedy}"
    standard = LEVELS[AccuracyLevel.STANDARD]
    other = run(replace(plan.without_outputs(), accuracy=standard))
    if other.overturned is None:
        return None
    difference = abs(other.peak - shown.peak)
    if shown.alike(other) and difference <= PEAK_TOLERANCE * other.peak:
        return None
    if negligible and other.overturned is False and other.peak_share <= NEGLIGIBLE_PEAK:
        return None
    ends = "overturns" if other.overturned else f"has a peak rotation of {other.peak:.4g} rad"
    return (
        f"{found}, and adaptive steps give another course, which {ends}: this is no "
        f"solution; {remedy}"
    )


AT_REST_SHARE: Final = 0.2
"""Share of the overturning angle, and of the typical size of each velocity, below which a body has
too little energy to overturn: at that angle at rest, about a third of it, 1 - (1 - 0.2)^2."""

STILL_MOVING: Final = (
    "the run ends while the body, which counts as standing, still has the energy to overturn: add "
    "free_vibration='10 s', still ground after the motion, to see whether it comes to rest"
)


def may_overturn_later(system: Assembly, summary: Summary) -> bool:
    """Whether a body that has not overturned has enough energy left to do so.

    The ground is still by then: its energy is the kinetic energy, and the work that slowly brings
    it to its rotation, :eq:`eq-overturning-energy`. Beyond the overturning angle no energy is
    needed, unless links hold the body there.
    """
    if summary.overturned is not False:
        return False
    model, setting, ending = system.model, system.setting, summary.ending
    rotation, size = model.rotation_in(ending.state), model.system.coordinates()
    rates, sizes = ending.state[size : 2 * size], model.scales[size : 2 * size]
    others = model.other_share_in(ending.state)
    upright = abs(rotation) < AT_REST_SHARE * setting.overturning_angle and others < AT_REST_SHARE
    beyond = abs(rotation) >= setting.overturning_angles.on_side_of(rotation) or others >= 1.0
    held = upright or (beyond and bool(setting.link_names))
    if held and bool(np.all(np.abs(rates) < AT_REST_SHARE * sizes)):
        return False
    # user-defined scenes have no `joined_bodies`
    if beyond or (setting.joined_bodies and _lower_body_may_overturn(system, ending)):
        return True
    kinetic, needed = _kinetic_energy(system, ending), setting.overturning_energy
    if kinetic + max_stored_energy(system, rotation) < needed:
        return False
    return 0.0 < needed <= kinetic + setting.stored_energy(rotation)


def max_stored_energy(system: Assembly, rotation: float) -> float:
    """Return an upper bound of the energy stored at a rotation, which is costly to compute [J].

    The restoring moment on a level base is at most the weight times its distance from a corner.
    Infinite where a slope, links, a wall, a beam or a user's own part may add to it.
    """
    parts, setting = system.parts, system.setting
    if parts.links or parts.walls or parts.frame or parts.own or not setting.slope.level:
        return math.inf
    body = setting.body
    return body.mass * setting.gravity * max(body.left, body.right) * abs(rotation)


def _lower_body_may_overturn(system: Assembly, ending: Ending) -> bool:
    """Whether a lower body, with all above it as one rigid body, has the energy to fall."""
    size = len(system.model.rotation_weights)
    weights = system.model.other_limits.reshape(-1, 2 + size)[:, 2:]
    rotations, rates = (weights @ ending.state[of : of + size] for of in (0, size))
    for whole, rotation, rate in zip(system.setting.joined_bodies, rotations, rates, strict=True):
        across = whole.right if rotation > 0.0 else whole.left
        left = whole.overturning_angles.on_side_of(rotation) - abs(rotation)
        lift = math.hypot(across, whole.centre_height) * (1.0 - math.cos(left))
        motion = 0.5 * whole.gyration_square_about(across) * rate**2
        if motion >= system.options.gravity * lift:
            return True
    return False


def _kinetic_energy(system: Assembly, ending: Ending) -> float:
    """Return the kinetic energy of the body relative to the ground [J]."""
    model, body = system.model, system.setting.body
    ground = Ground(system.options.slope.along_gravity, 0.0)
    slope = model.system.accelerate(ending.mode, ending.state, ground)
    seen = model.system.observe(ending.mode, ending.state, slope, ground, ending.memory)
    found = dict(zip((column.name for column in model.columns), seen, strict=True))
    square = found["horizontal_velocity"] ** 2 + found["vertical_velocity"] ** 2
    return 0.5 * (body.mass * square + body.inertia * found["angular_velocity"] ** 2)


_CONTACTS: Final = ("flies", "on its left corner", "on its right corner", "in full contact")
_ONE_OF: Final = "what follows is one of several motions"


def nonunique_motions(
    model: ContactModel, chain: RigidChain, run: Trajectory
) -> tuple[dict[str, int], list[str]]:
    """Count changes of contact after which motion on rigid bases is not unique, and say so."""
    events = run.events
    sets, taken, other = (events.memory[:, model.memory.index(name)] for name in SET_MEMORY)
    by_force = np.isin(events.kind, (UPLIFT, SEPARATION, SILENT))
    slips = np.isin(events.kind, (SLIP, STICK, REVERSAL))
    impacts = ~by_force & ~slips & ~np.isin(events.kind, (OVERTURNING, TOPPLED))
    several, none = impacts & (sets > 1.0), impacts & (sets == 0.0)
    held = events.kind == SILENT
    held &= sets == 0.0
    rigid = [k for k in range(chain.bodies()) if chain.is_rigid(k)]
    unsure = slips & (sets != 1.0)
    cautions = list[str]()

    def add_caution(which: NDArray[np.bool_], words: Callable[[int], str]) -> None:
        """Add a caution about the first of some events."""
        for i in np.flatnonzero(which)[:1].tolist():
            cautions.append(f"at {events.time[i]:.6g} s {words(i)}")

    add_caution(several, lambda i: (
        f"an impact has {int(sets[i])} modes: taken is that which loses the least energy, "
        f"{_contact_words(int(taken[i]), rigid)}; the next is "
        f"{_contact_words(int(other[i]), rigid)}; such impacts: "
        f"{several.sum()}; {_ONE_OF}"
    ))  # fmt: skip
    add_caution(none, lambda i: (
        "an impact has no mode, and is computed with every closed contact held along itself: "
        f"{_contact_words(int(taken[i]), rigid)}; such impacts: {none.sum()}; {_ONE_OF}"
    ))  # fmt: skip
    add_caution(unsure, lambda i: (
        f"a slip begins or ends, and there are {int(sets[i]) or 'no'} ways to bear and to slip "
        f"then: taken is one with {_contact_words(int(taken[i]), rigid)}; such changes: "
        f"{unsure.sum()}; {_ONE_OF}"
    ))  # fmt: skip
    add_caution(held, lambda _: (
        "a corner is held though it does not press, since it would return at once if it were "
        f"released; such events: {held.sum()}"
    ))  # fmt: skip
    counts = {
        "impacts_of_several_modes": int(several.sum()),
        "impacts_of_no_mode": int(none.sum()),
        "corners_held_without_pressing": int(held.sum()),
    }
    return counts, cautions


def _contact_words(corners: int, rigid: Sequence[int]) -> str:
    """Say which corners of bodies on rigid bases bear, from the top down."""
    return ", ".join(f"body {k + 1} {_CONTACTS[corners >> 2 * k & 3]}" for k in rigid)
