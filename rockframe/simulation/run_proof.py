"""The proof of the verdict of a planned run, and the scenes for which there is one."""

from dataclasses import replace
from importlib.util import find_spec
from typing import Any

from rockframe.components import InitialState
from rockframe.dynamics.body import LEADING_CORNER
from rockframe.dynamics.pads import ElasticPads
from rockframe.dynamics.protocol import Ending
from rockframe.dynamics.rigid_ground import BlockOnRigidGround
from rockframe.dynamics.single_body import SingleBody
from rockframe.errors import ComponentError
from rockframe.proof.verdict import EXACT, Proof, Tolerances
from rockframe.simulation.plan import InitialCondition, Plan, start_of
from rockframe.system.assembly import Assembly


def prove_run(
    system: Assembly,
    plan: Plan,
    *,
    scale: float = 1.0,
    within: Tolerances = EXACT,
    owner: str,
) -> Proof:
    """Prove the verdict of a planned run; raise ComponentError if that is not possible."""
    model, motion = system.model, plan.motion
    faults = _faults(system)
    if not plan.stop_at_overturning:
        faults.append("proofs are of reaching the overturning angle; leave out overturning")
    if motion is None:
        faults.append("there is no motion")
    if isinstance(model.system, SingleBody) and (within.scale or within.angle):
        faults.append("proofs on pads are of exact scales and angles")
    if not within.scale < scale:
        faults.append(f"scale_tolerance must be below the scale, {scale:g}, got {within.scale:g}")
    if find_spec("flint") is None:
        faults.append("python-flint is not installed: pip install rockframe[proof]")
    if faults or motion is None:
        msg = f"{owner}: {'; '.join(faults)}"
        raise ComponentError(msg)
    start = start_of(plan.initial)
    if isinstance(start, Ending):
        mode, state = start.mode, start.state
    else:
        mode, state, _ = model.initial(start)
    law, slope, limits = model.system, system.options.slope, system.setting.overturning_angles
    context: dict[str, Any] = {
        "analytic": motion.si.analytic,
        "gravity": system.options.gravity,
        "start": _start_in_words(plan.initial),
    }
    if isinstance(law, SingleBody):
        from rockframe.proof.pads.verdict import prove_pads

        found = prove_pads(law, mode, state, motion.si, slope, limits, scale=scale, within=within)
        return replace(found, **context)
    assert isinstance(law, BlockOnRigidGround)  # noqa: S101
    from rockframe.proof.rocking import prove_block

    begin = float(state[0]), float(state[1])
    found = prove_block(law, motion.si, slope, limits, begin, scale=scale, within=within)
    return replace(found, **context)


def _start_in_words(initial: InitialCondition) -> str:
    """Write the state at the start of a run, with all digits of its numbers."""
    if isinstance(initial, Ending):
        return "the state in which the run before it ended"
    given = {name: value for name, value in vars(initial.given).items() if value is not None}
    if not given:
        return "a start at rest"
    units = {name: one.unit for name, one in InitialState.declared().items()}
    listed = " and ".join(
        f"{name.replace('_', ' ')} {value!r} {units[name]}" for name, value in given.items()
    )
    return f"a start with {listed}"


def _faults(system: Assembly) -> list[str]:
    """Say why the verdicts of a scene cannot be proved; empty if they can."""
    law, options = system.model.system, system.options
    if isinstance(law, BlockOnRigidGround):
        faults = ["proofs on rigid ground are with rotation='finite'"] if options.small else []
        if law.wall != 0.0:
            faults.append("proofs are of a Block that rocks to both sides, without a RearWall")
        return faults
    if not isinstance(law, SingleBody) or not isinstance(law.part.base, ElasticPads):
        return [
            "proofs are of a Block on rigid ground, or on a TwoSpringSupport without friction, "
            "with nothing tied to it"
        ]
    faults = [] if options.slope.level else ["proofs on pads are on level ground"]
    if law.part.body.restraint == LEADING_CORNER:
        faults.append("proofs on pads are with restraint='contact-state' or 'centre'")
    return faults
