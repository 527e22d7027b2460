"""Bounds of small bounces contain the separate runs of members of a set."""

import numpy as np
import pytest

import rockframe as rf

pytest.importorskip("flint", reason="python-flint is not installed")

from rockframe.proof import bounces, rocking
from rockframe.proof.balls import UNIT, ball, working_precision
from rockframe.proof.bounces import Instant, UpliftState, follow_bounces
from rockframe.proof.impacts import ImpactEnclosure
from rockframe.proof.problem import Deviations, Problem
from rockframe.signals.motion import Motion, Signal

STEP = 0.02
BLOCKS = {
    "symmetric": rf.Block.from_size(radius="2 m", slenderness=4, mass="20 t"),
    "skew": rf.Block(width="0.8 m", height="4 m", mass="9 t", centre_of_mass=("2 m", "0.05 m")),
}
HEIGHT, SPEED = 1e-6, 1e-3


def ground(first, last, other=0.0):
    """Return accelerations, linear from one value to another, with vertical ones."""
    across = np.concatenate([np.linspace(first, last, 21), np.full(5, last)])
    up = other * np.sin(np.arange(across.size))
    return rf.GroundMotion.from_arrays((across, "m/s^2"), f"{STEP} s", vertical=(up, "m/s^2"))


GROUNDS = {
    "still": ground(0.0, 0.0),
    "strong to one side": ground(0.9, 0.5, 0.02),
    "it lifts the block soon": ground(-1.5, -5.0),
    "it lifts the block late": ground(-1.5, -3.4, 0.02),
    "it lifts to the other side": ground(1.0, -3.2),
}


def follow_bounces_of(block, motion):
    system = rf.System(block, gravity="9.81 m/s^2")
    assembly = system.assembly
    with working_precision(106):
        problem = Problem.of(
            assembly.model.system, motion.si, assembly.options.slope,
            assembly.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip
        result = follow_bounces(problem, Instant(0, ball(0)), ball(HEIGHT), ball(SPEED))
    return system, result


def final_states_of_members(system, motion, until):
    """Run members of the set to a time; yield their states there."""
    for rotation in (-HEIGHT, -0.3 * HEIGHT, 0.0, HEIGHT):
        for rate in (-SPEED, -0.1 * SPEED, 0.2 * SPEED, 0.9999 * SPEED):
            run = system.simulate(
                motion,
                duration=f"{until} s",
                output_step=f"{until} s",
                initial=rf.InitialState(
                    rotation=f"{rotation} rad", angular_velocity=f"{rate} rad/s"
                ),
                accuracy="reference",
            )
            yield float(run.rotation[-1]), float(run.angular_velocity[-1])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", BLOCKS)
@pytest.mark.parametrize("shaking", GROUNDS)
def test_every_member_rests_or_uplifts_within_bounds(name, shaking):
    motion = GROUNDS[shaking]
    system, result = follow_bounces_of(BLOCKS[name], motion)
    assert result is not None
    instant = result.instant if isinstance(result, UpliftState) else result
    until = instant.interval * STEP + float(instant.elapsed)
    states = list(final_states_of_members(system, motion, until))
    if isinstance(result, UpliftState):
        assert shaking.startswith("it lifts")
        for state in states:
            for one, value in zip(result.box, state, strict=True):
                assert float(one.lower()) - 1e-12 <= value <= float(one.upper()) + 1e-12
        # bounds are at most a few times the exact spread
        spread = max(abs(rate) for _, rate in states)
        assert float(result.box[1].abs_upper()) < 4.0 * spread
    else:
        assert until < 1.0
        assert set(states) == {(0.0, 0.0)}


def test_overestimated_bounce_losses_are_caught(monkeypatch):
    motion, block = GROUNDS["strong to one side"], BLOCKS["symmetric"]
    right = bounces._Bounds.restitution
    monkeypatch.setattr(bounces._Bounds, "restitution", property(lambda of: right.fget(of) / 3))
    system, instant = follow_bounces_of(block, motion)
    until = instant.interval * STEP + float(instant.elapsed)
    assert any(state != (0.0, 0.0) for state in final_states_of_members(system, motion, until))


def test_rotations_are_bounded_as_slow_ground_lifts_block():
    """The ground needs three times 1/p to lift a block on the verge of uplift."""
    system = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2")
    assembly, duration = system.assembly, "1.6 s"
    verge = -9.81 * float(np.tan(assembly.model.system.right.angle))
    motion = rf.GroundMotion.from_arrays(([0.9995 * verge, verge], "m/s^2"), duration)
    with working_precision(106):
        problem = Problem.of(
            assembly.model.system, motion.si, assembly.options.slope,
            assembly.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip
        window, speed = ball(1.6), ball(0.01)
        bounds = bounces._Bounds(problem, ball(0), speed)
        for halvings in range(4, 8):  # no bounds hold over longer windows
            span = window / 2**halvings
            bound = bounds.after_window(problem.ground(0).at(UNIT * span), span)
            run = system.simulate(
                motion, duration=f"{float(span)} s", accuracy="reference",
                initial=rf.InitialState(rotation="0 rad", angular_velocity="0.01 rad/s"),
            )  # fmt: skip
            assert 0.4 * bound.height < float(run.peak_rotation) <= bound.height


def test_members_before_impact_use_speed_before_impact(monkeypatch):
    system, speeds = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2"), []
    assembly = system.assembly
    monkeypatch.setattr(
        rocking, "follow_bounces", lambda *arguments: speeds.append(float(arguments[3]))
    )
    with working_precision(106):
        problem = Problem.of(
            assembly.model.system, GROUNDS["still"].si, assembly.options.slope,
            assembly.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip
        prover = rocking.RockingProver(problem)
        prover.start(0.0, SPEED)
        # all members strike within two and a half samples from now
        at = ball(0, 2.5 * STEP)
        prover.last_impact = ImpactEnclosure(prover.states, at, ball(HEIGHT), ball(2 * SPEED))
        for _ in range(3):
            prover.states, prover.just_lifted = (
                prover.states._replace(centre=[ball(0), ball(0.1)]),
                True,
            )
            prover._follow_rocking()
            prover.states = prover.states._replace(centre=[ball(HEIGHT), ball(SPEED)])
            prover._settle_bounces(lift=True)
    assert min(speeds[:2]) >= 2 * SPEED
    assert speeds[2] < 1.1 * SPEED


def test_jumping_ground_is_detected_and_widens_speed_bound():
    block = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2").assembly
    lines = GROUNDS["strong to one side"]
    jumping = rf.GroundMotion.sine_pulse("1 m/s^2", "2 Hz")

    def problem(motion):
        return Problem.of(
            block.model.system, motion.si, block.options.slope,
            block.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip

    with working_precision(106):
        straight, closed = problem(lines), problem(jumping)
        last = straight.count - 1
        assert [straight.is_continuous_after(k) for k in (0, last - 1, last, last + 1)] == [
            True,
            True,
            False,
            True,
        ]
        assert not closed.is_continuous_after(0)
        bounds = bounces._Bounds(straight, ball(HEIGHT), ball(SPEED))
        assert bounds.after_jump(0) is bounds
        after = bounds.after_jump(last).remaining_speed - ball(SPEED)
        # 0.5 m/s^2 vanish at once: a fall through the height may then add this speed
        corner = straight.right
        assert after**2 >= 2 * HEIGHT * corner.ratio * 0.5
        assert after**2 < 4 * HEIGHT * corner.ratio * 0.5


def test_uplift_by_jump_of_ground_is_not_followed():
    """The ground jumps to 1.6 times the acceleration of uplift, and rises further."""
    system = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2").assembly
    pieces = np.zeros((6, 6))
    pieces[3:, 0], pieces[3:, 1] = [-4.0, -4.2, -4.4], -0.2
    motion = Motion(Signal(STEP, np.append(pieces[:, 0], -4.6), pieces))
    with working_precision(106):
        problem = Problem.of(
            system.model.system, motion, system.options.slope,
            system.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip
        start = Instant(2, ball(0.0199))
        assert follow_bounces(problem, start, ball(1e-9), ball(1e-5)) is None


def test_least_restoring_acceleration_is_that_of_the_weaker_side(monkeypatch):
    """They differ by less than floats show."""
    system, found = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2").assembly, []
    with working_precision(106):
        most, least = ball(2) + ball(2) ** -80, ball(2)
    for stronger in (1, -1):

        def of(_, sign, *__, stronger=stronger):
            return bounces.RestoringAcceleration(most if sign == stronger else least, most, ball(0))

        with working_precision(106):
            monkeypatch.setattr(bounces.RestoringAcceleration, "of", of)
            problem = Problem.of(
                system.model.system, GROUNDS["still"].si, system.options.slope,
                system.setting.overturning_angles, 1.0, Deviations(), 0.1,
            )  # fmt: skip
            bounds = bounces._Bounds(problem, ball(HEIGHT), ball(SPEED))
            found.append(bounds.after_window(problem.ground(0), ball(STEP / 8)))
    first, second = found
    assert first.remaining_speed == second.remaining_speed


@pytest.mark.parametrize(
    ("first", "last", "rotation", "rate"),
    [(1.05, 1.05, 0.0, 0.01), (0.75, 0.6, 1e-3, 0.0), (0.6, 0.75, 1e-3, 0.0)],
    ids=["the ground lifts it", "it restores more and more", "it restores less and less"],
)
def test_bounds_after_a_window_are_those_of_a_member(first, last, rotation, rate):
    """Ground accelerations are shares of that which lifts the block; no impact occurs."""
    system, span = rf.System(BLOCKS["symmetric"], gravity="9.81 m/s^2"), 0.025
    assembly = system.assembly
    corner = assembly.model.system.right
    across = -9.81 * corner.tangent * np.array([first, last])
    motion = rf.GroundMotion.from_arrays((across, "m/s^2"), f"{span} s")
    run = system.simulate(
        motion, duration=f"{span} s", accuracy="reference",
        initial=rf.InitialState(rotation=f"{rotation} rad", angular_velocity=f"{rate} rad/s"),
    )  # fmt: skip

    def speed(rotation, rate, along):
        """Return u: the rate, and what falling to the ground would add."""
        lean = corner.angle - rotation
        rise, shift = np.cos(lean) - np.cos(corner.angle), np.sin(lean) - np.sin(corner.angle)
        work = corner.radius / corner.inertia * (9.81 * rise - along * shift)
        return float(np.sqrt(rate**2 + 2.0 * max(work, 0.0)))

    with working_precision(106):
        problem = Problem.of(
            assembly.model.system, motion.si, assembly.options.slope,
            assembly.setting.overturning_angles, 1.0, Deviations(), 0.1,
        )  # fmt: skip
        start = ball(speed(rotation, rate, across[0]))
        window = ball(span)
        bounds = bounces._Bounds(problem, ball(rotation), start)
        bounds = bounds.after_window(problem.ground(0).at(UNIT * window), window)
        ends = float(run.rotation[-1]), float(run.angular_velocity[-1])
        assert float(bounds.height) >= ends[0] > 0.0
        assert float(bounds.remaining_speed) >= corner.restitution * speed(*ends, across[1])
        assert float(bounds.speed) >= abs(ends[1])
