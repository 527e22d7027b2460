"""The ground acceleration in all lanes, at a place of each lane's own interval."""

from typing import Final

from rockframe.compiled import ReadOnlyMatrix, Vector, inlined, lane_of
from rockframe.solve import layout as at
from rockframe.solve.lanes import fields
from rockframe.solve.workspace import TERMS

RECORDED: Final = 1
"""Degree of the polynomials of a motion that is a record."""


@inlined
def evaluate_ground(
    lanes: int, room: Vector, pieces_x: ReadOnlyMatrix, pieces_y: ReadOnlyMatrix,
    fraction: float, x: int, y: int,
) -> None:  # fmt: skip
    """Write the acceleration at a fraction of the step in all lanes to two of their own fields."""
    for lane in range(lanes):
        clock, controls = lane_of(room, fields.CLOCK, lane), lane_of(room, fields.CONTROLS, lane)
        own = lane_of(room, fields.OWN, lane)
        place = clock[at.INTO_INTERVAL] / controls[at.TIME_STEP]
        share = own[fields.STEP] / controls[at.TIME_STEP]
        own[fields.PLACE] = place + fraction * share
    evaluate(lanes, room, pieces_x.shape[1] - 1, 0, x)
    if len(pieces_y) > 0:
        evaluate(lanes, room, pieces_y.shape[1] - 1, TERMS, y)


@inlined
def evaluate(lanes: int, room: Vector, degree: int, first: int, out: int) -> None:
    """Evaluate the polynomials of one direction."""
    if degree == RECORDED:  # at places that are known when this is compiled
        for lane in range(lanes):
            own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
            own[out] = ground[first + 1] * own[fields.PLACE] + ground[first]
        return
    for lane in range(lanes):
        own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
        own[out] = ground[first + degree]
    for j in range(degree - 1, -1, -1):
        for lane in range(lanes):
            own, ground = lane_of(room, fields.OWN, lane), lane_of(room, fields.GROUND, lane)
            own[out] = own[out] * own[fields.PLACE] + ground[first + j]
