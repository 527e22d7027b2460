"""The motion of points of a rigid body, from that of its centre of mass, :eq:`eq-point-motion`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rockframe.results.along_steps import AlongSteps
from rockframe.results.outcome import Generic, sines_cosines
from rockframe.results.variables.requests import POINT_PEAKS
from rockframe.signals.arrays import Array
from rockframe.system.load import Load


@dataclass(frozen=True)
class BodyPoint:
    """A point of a body."""

    name: str  # that it is called by
    x: float  # to the right of the middle of the base and above it, at rest [m]
    y: float


def rotated_points(
    right: Array, up: Array, rotation: Array, *, small_rotation: bool
) -> tuple[Array, Array]:
    """Give how a rotation moves points about the point that they are measured from.

    By :eq:`eq-point-motion`.
    """
    if small_rotation:
        half = 0.5 * rotation
        return up * rotation, -right * rotation - up * (2.0 * half * half)
    half = np.sin(0.5 * rotation)
    rise = 2.0 * half * half  # 1 - cos a, to all digits
    sine = np.sin(rotation)
    return up * sine - right * rise, -right * sine - up * rise


def point_labels(points: Sequence[BodyPoint]) -> dict[str, Generic]:
    """Give names and places of points, by their names in the schema."""
    return {
        "point": np.array([point.name for point in points]),
        "point_x": np.array([point.x for point in points]),
        "point_y": np.array([point.y for point in points]),
    }


def point_histories(
    points: Sequence[BodyPoint], values: Mapping[str, Generic], load: Load
) -> dict[str, Generic]:
    """Give displacements and absolute accelerations of points."""
    rotation, rate = values["rotation"], values["angular_velocity"]
    angular = values["angular_acceleration"]
    body, small = load.body, load.options.small
    places = np.array([(point.x, point.y) for point in points])[:, :, None]
    right, up = body.arms(places[:, 0], places[:, 1], rotation)
    sine, cosine = sines_cosines(rotation, small=small)
    # derivatives of the place about the centre of mass by the rotation
    across_rate, up_rate = up * cosine - right * sine, -right * cosine - up * sine
    across_bend, up_bend = -right * cosine - up * sine, right * sine - up * cosine
    if small:  # heights to second order, widths to first
        across_rate, up_rate = up + 0.0 * rotation, -right - up * rotation
        across_bend, up_bend = np.zeros_like(up_rate), -up + 0.0 * rotation
    across, above = rotated_points(right, up, rotation, small_rotation=small)
    square = rate * rate
    x, y = values["horizontal_displacement"], values["vertical_displacement"]
    a_x = values["absolute_horizontal_acceleration"]
    a_y = values["absolute_vertical_acceleration"]
    return {
        "point_horizontal_displacement": x + across,
        "point_vertical_displacement": y + above,
        "point_horizontal_acceleration": a_x + across_rate * angular + across_bend * square,
        "point_vertical_acceleration": a_y + up_rate * angular + up_bend * square,
    }


def point_peaks(points: Sequence[BodyPoint], along: AlongSteps, load: Load) -> dict[str, Generic]:
    """Give peaks of displacements and absolute accelerations of points."""

    def sizes(values: Mapping[str, Generic]) -> Array:
        return np.abs(np.concatenate([*point_histories(points, values, load).values()]))

    peaks, _ = along.largest(sizes)
    return {
        row.name: one
        for row, one in zip(POINT_PEAKS, np.split(peaks, len(POINT_PEAKS)), strict=True)
    }
