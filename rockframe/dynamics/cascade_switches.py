"""Switches of a cascade: those of its two bodies, and what the first one's do to the second.

Where the first body is re-pinned, the velocity of the cap's top jumps, :eq:`eq-carried-jump`.
"""

from rockframe.compiled import Vector, callback, kernel
from rockframe.dynamics import two_spring as pads
from rockframe.dynamics import two_spring_switches as pad_switches
from rockframe.dynamics import winkler as soil
from rockframe.dynamics.cascade import (
    BLOCK_MODES,
    COORDINATES,
    FIRST_MEMORY,
    FIRST_PARAMETERS,
    MASS_RATIO,
    SOIL_GUARDS,
    shaking,
    top_motion,
)
from rockframe.dynamics.kinematics import pinned_point, reach_and_bend, sine_cosine_rise
from rockframe.dynamics.protocol import (
    IMPULSIVE_INPUT,
    LAST_EVENT,
    PIVOT_CHANGE,
    REPINNING_LOSS,
    SEPARATION,
    SILENT,
    SOIL_CONTACT,
    SOIL_PIVOT_CHANGE,
    SOIL_SEPARATION,
    SWITCH,
)
from rockframe.dynamics.single_body import COORDINATES as BODY_COORDINATES
from rockframe.dynamics.single_body import (
    FREE,
    HALF_HEIGHT,
    HALF_WIDTH,
    HORIZONTAL,
    INERTIA,
    ROTATION,
    SMALL,
    VERTICAL,
    horizontal_velocity,
)


@kernel
def jolt(mode: int, jump_x: float, jump_y: float, state: Vector, p: Vector, memory: Vector) -> None:
    """Let the velocity of a body's ground jump, :eq:`eq-carried-jump`; the body is on pads."""
    pivot = pads.pivot_in(mode)
    sine, cosine, _ = sine_cosine_rise(p[HALF_HEIGHT], p[SMALL], state[ROTATION])
    sway = horizontal_velocity(pivot, state, p, sine, cosine)
    speed = state[BODY_COORDINATES + VERTICAL]
    state[BODY_COORDINATES + VERTICAL] -= jump_y
    if pivot == FREE:
        state[BODY_COORDINATES + HORIZONTAL] -= jump_x
    else:
        pin = pinned_point(pivot, p[HALF_WIDTH])
        reach, _ = reach_and_bend(p[HALF_HEIGHT], p[SMALL], pin, sine, cosine)
        state[BODY_COORDINATES + ROTATION] -= reach * jump_x / (p[INERTIA] + reach * reach)
    after = horizontal_velocity(pivot, state, p, sine, cosine)
    memory[IMPULSIVE_INPUT] -= 0.5 * (
        jump_x * (sway + after) + jump_y * (speed + state[BODY_COORDINATES + VERTICAL])
    )


@kernel
def switch_first(
    mode: int, which: int, state: Vector, ground_x: float, ground_y: float, p: Vector,
    memory: Vector,
) -> int:  # fmt: skip
    """Carry out a switch of the first body, and jolt the second."""
    own = memory[FIRST_MEMORY:]
    lost = own[REPINNING_LOSS]
    before = top_motion(mode, state, 0.0, 0.0, 0.0, p)
    bed_mode = soil.switch(
        mode // BLOCK_MODES, which, state[::2], ground_x, ground_y, p[:FIRST_PARAMETERS], own
    )
    block_mode = mode % BLOCK_MODES
    new = block_mode + BLOCK_MODES * bed_mode
    after = top_motion(new, state, 0.0, 0.0, 0.0, p)
    memory[REPINNING_LOSS] += p[MASS_RATIO] * (own[REPINNING_LOSS] - lost)
    event = int(own[LAST_EVENT])
    if event == PIVOT_CHANGE:
        event = SOIL_PIVOT_CHANGE
    elif event == SEPARATION:
        event = SOIL_SEPARATION
    elif event != SILENT:
        event = SOIL_CONTACT
    memory[LAST_EVENT] = event
    second = p[FIRST_PARAMETERS:]
    jump_x, jump_y = after.velocity_x - before.velocity_x, after.velocity_y - before.velocity_y
    jolt(block_mode, jump_x, jump_y, state[1::2], second, memory)
    return new - block_mode + pad_switches.judged_anew_in(block_mode, state[1::2], second)


@callback(SWITCH)
def switch(
    mode: int,
    guard_index: int,
    state: Vector,
    ground_x: float,
    ground_y: float,
    p: Vector,
    memory: Vector,
) -> int:
    """Carry out the switch that a guard calls for; give the new mode."""
    if guard_index >= SOIL_GUARDS:
        new = switch_first(mode, guard_index - SOIL_GUARDS, state, ground_x, ground_y, p, memory)
    else:
        x, y = shaking(mode, state, ground_x, ground_y, p)
        block_mode = pad_switches.switch(
            mode % BLOCK_MODES, guard_index, state[1::2], x, y, p[FIRST_PARAMETERS:], memory
        )
        new = mode - mode % BLOCK_MODES + block_mode
    # a held body's own horizontal coordinate rests while the other one's moves
    sway = COORDINATES + 2 * HORIZONTAL
    if soil.pivot_in(new // BLOCK_MODES) != FREE:
        state[sway] = 0.0
    if pads.pivot_in(new % BLOCK_MODES) != FREE:
        state[sway + 1] = 0.0
    return new
