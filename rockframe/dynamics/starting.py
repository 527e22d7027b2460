"""Where a run of stacked bodies starts: mode, state and memory, from placements on their bases."""

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple

from rockframe.compiled import Vector
from rockframe.dynamics.bodies import BEFORE_HORIZONTAL, ROTATION, VERTICAL
from rockframe.dynamics.body import BodyState
from rockframe.dynamics.on_base import BodyOnBase
from rockframe.dynamics.protocol import HELD_PLACE, Start


class AtRest(NamedTuple):
    """Placement of a body at rest relative to what it stands on."""

    rotation: float  # [rad]
    vertical: float  # displacement of its centre of mass [m]


UPRIGHT: Final = AtRest(0.0, 0.0)


class StartingBody(NamedTuple):
    """A body on its base, at the start of a run."""

    part: BodyOnBase
    law: Any  # of its base
    offset: float  # centre of mass to the right of that of the body beneath, upright [m]


def starting_placements(
    rest: Sequence[AtRest], start: Start, height_at: Callable[[float], float]
) -> list[AtRest]:
    """Return placements of all bodies: at rest, but of the highest as `start` says."""
    if start.rotation is None and start.vertical_displacement is None:
        return list(rest)
    rotation, height = rest[0].rotation, start.vertical_displacement
    if start.rotation is not None:
        rotation = start.rotation - sum(placement.rotation for placement in rest[1:])
    return [AtRest(rotation, height_at(rotation) if height is None else height), *rest[1:]]


def write_start(
    system: Any,
    bodies: Sequence[StartingBody],
    placements: Sequence[AtRest],
    start: Start,
    state: Vector,
    memory: Vector,
    lowest_moves: bool = False,  # whether its horizontal coordinate is integrated while it is held
) -> int:
    """Write places, velocities and held points, all at rest but the highest; return the mode."""
    mode, n, body = 0, system.coordinates(), BodyState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for k, ((part, law, offset), placement) in enumerate(zip(bodies, placements, strict=True)):
        rates = (start.angular_velocity, start.vertical_velocity) if k == 0 else (0.0, 0.0)
        above, body = body, BodyState(*placement, 0.0, *rates, 0.0)
        # a body at rest upright has no side yet: it takes that of the body above
        leaning = above if k > 0 and body.rotation == 0.0 else body
        own = law.read(state, system.base_variable_index(k))
        contact = law.starting(part.body.base_line_at(body), own)
        body_mode = part.mode_for_contact(contact, leaning)
        pin, attitude = part.initial_pin(body_mode, leaning), part.body.attitude(body.rotation)
        i, x = BEFORE_HORIZONTAL * k, system.horizontal_of(k)
        state[i + ROTATION], state[i + VERTICAL] = placement
        state[n + i + ROTATION], state[n + i + VERTICAL] = rates
        memory[HELD_PLACE + k] = pin + offset
        moves, free = lowest_moves or k + 1 < len(bodies), part.is_free(body_mode)
        if moves or free:
            state[x] = pin + offset + part.body.about_pin(pin, attitude)
        if moves and not free:
            state[n + x] = part.body.reach(pin, attitude).derivative * body.angular_velocity
        mode = system.with_body_mode(mode, k, body_mode)
    return mode
