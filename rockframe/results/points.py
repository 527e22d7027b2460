"""The motion of points of a body, :eq:`eq-point-motion`, and where the parts of a scene are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rockframe.dynamics.body import PIVOT_LEFT, PIVOT_RIGHT, pivot_of
from rockframe.dynamics.events import ContactState
from rockframe.results.along_steps import AlongSteps
from rockframe.results.outcome import sines_cosines
from rockframe.results.variables.requests import POINT_PEAKS
from rockframe.signals.arrays import AnyArray, Array
from rockframe.system.bodies import BaseLoad
from rockframe.system.geometry import Geometry
from rockframe.system.options import RESTRAINT_CODES, Restraint


@dataclass(frozen=True)
class BodyPoint:
    """A point of a body."""

    name: str  # name in results
    x: float  # to the right of the middle of the base and above it, at rest [m]
    y: float


def rotated_points(
    right: Array, up: Array, rotation: Array, *, small_rotation: bool
) -> tuple[Array, Array]:
    """Return the displacements of points in a rotation about the origin, :eq:`eq-point-motion`."""
    if small_rotation:
        half = 0.5 * rotation
        return up * rotation, -right * rotation - up * (2.0 * half * half)
    half = np.sin(0.5 * rotation)
    rise = 2.0 * half * half  # 1 - cos a, to all digits
    sine = np.sin(rotation)
    return up * sine - right * rise, -right * sine - up * rise


def point_labels(points: Sequence[BodyPoint]) -> dict[str, AnyArray]:
    """Return names and places of points, by their names in the schema."""
    return {
        "point": np.array([point.name for point in points]),
        "point_x": np.array([point.x for point in points]),
        "point_y": np.array([point.y for point in points]),
    }


def point_histories(
    points: Sequence[BodyPoint], values: Mapping[str, AnyArray], load: BaseLoad
) -> dict[str, AnyArray]:
    """Return displacements and absolute accelerations of points."""
    rotation, rate = values["rotation"], values["angular_velocity"]
    angular = values["angular_acceleration"]
    body, small = load.body, load.options.small
    places = np.array([(point.x, point.y) for point in points])[:, :, None]
    right, up = body.relative_to_centre(places[:, 0], places[:, 1], values)
    sine, cosine = sines_cosines(rotation, small=small)
    # derivatives of the place about the centre of mass by the rotation
    across_rate, up_rate = up * cosine - right * sine, -right * cosine - up * sine
    across_second, up_second = -right * cosine - up * sine, right * sine - up * cosine
    if small:  # heights to second order, widths to first
        across_rate, up_rate = up + 0.0 * rotation, -right - up * rotation
        across_second, up_second = np.zeros_like(up_rate), -up + 0.0 * rotation
    across, above = rotated_points(right, up, rotation, small_rotation=small)
    square = rate * rate
    x, y = values["horizontal_displacement"], values["vertical_displacement"]
    a_x = values["absolute_horizontal_acceleration"]
    a_y = values["absolute_vertical_acceleration"]
    return {
        "point_horizontal_displacement": x + across,
        "point_vertical_displacement": y + above,
        "point_horizontal_acceleration": a_x + across_rate * angular + across_second * square,
        "point_vertical_acceleration": a_y + up_rate * angular + up_second * square,
    }


def point_peaks(
    points: Sequence[BodyPoint], along: AlongSteps, load: BaseLoad
) -> dict[str, AnyArray]:
    """Return peaks of displacements and absolute accelerations of points."""

    def sizes(values: Mapping[str, AnyArray]) -> Array:
        return np.abs(np.concatenate([*point_histories(points, values, load).values()]))

    peaks, _ = along.largest(sizes)
    return {
        row.name: peak
        for row, peak in zip(POINT_PEAKS, np.split(peaks, len(POINT_PEAKS)), strict=True)
    }


def _ends_in_contact(state: float) -> tuple[bool, bool]:
    """Return whether the left and whether the right end bears in a contact state."""
    full = state == ContactState.FULL
    return full or state == ContactState.LEFT, full or state == ContactState.RIGHT


UPRIGHT: Mapping[str, float] = {
    "rotation": 0.0,
    "horizontal_displacement": 0.0,
    "vertical_displacement": 0.0,
    "contact_state": float(ContactState.FULL),
}
"""The values of a scene that is upright and at rest."""


@dataclass(frozen=True)
class Placement:
    """A scene at an instant: where its bodies are, and which ends of bases bear."""

    geometry: Geometry  # the scene at rest
    values: Mapping[str, float]  # values at the instant, by their names in the schema
    restraint: Restraint  # which point of the base is held horizontally
    # rotation and both displacements of each body of a stack; None at rest
    bodies: Array | None = None
    broken: frozenset[int] = frozenset()  # restrainers that do not hold any more, from 0
    contacts: Array | None = None  # contact state of each body of a stack; None at rest

    def block(self, points: Array) -> Array:
        """Return where points of the block are, or of anything that is one body with it."""
        values = self.values
        if self.geometry.columns:
            return self._about_corner(points)
        moves = values["horizontal_displacement"], values["vertical_displacement"]
        return self._displaced(points, self.geometry.response_centre, values["rotation"], moves)

    def _about_corner(self, points: Array) -> Array:
        """Return where points of a column are, as if it stood in the middle of the frame.

        Points above the column belong to the beam, which moves with the upper corner that bears it.
        """
        rotation = np.array(self.values["rotation"])
        pivot, top = self.geometry.half_width * float(np.sign(rotation)), self.geometry.height
        of_beam = points[:, 1] > top
        right = np.where(of_beam, -2.0 * pivot, points[:, 0] - pivot)
        moves = rotated_points(
            right, np.where(of_beam, top, points[:, 1]), rotation,
            small_rotation=self.geometry.small_rotation,
        )  # fmt: skip
        return points + np.column_stack(moves)

    def beam(self, points: Array) -> Array:
        """Return where points of the beam on the columns are."""
        above = np.array([(0.0, 2.0 * self.geometry.height)])
        return points + self._about_corner(above) - above

    def lower(self, k: int, points: Array) -> Array:
        """Return where points of a body of a stack are, the `k`-th beneath the block."""
        rotation, right, up = np.zeros(3) if self.bodies is None else self.bodies[k + 1]
        return self._displaced(points, self.geometry.lower[k].centre, float(rotation), (right, up))

    def cap(self, points: Array) -> Array:
        """Return where points of the cap are, as :meth:`block` does."""
        if not self.geometry.stacked or self.geometry.cap is None:
            return self.block(points)
        half_width, height = self.geometry.cap
        rotation = self.values.get("cap_rotation", 0.0)
        pin = half_width * self._pivot_side(rotation)
        # the centre of mass about the held point, which does not move, as in eq-kinematics
        across, _ = rotated_points(
            np.array(-pin), np.array(0.5 * height), np.array(rotation),
            small_rotation=self.geometry.small_rotation,
        )  # fmt: skip
        moves = (
            float(across) + self.values.get("cap_slip", 0.0),
            self.values.get("cap_vertical_displacement", 0.0),
        )
        return self._displaced(points, (0.0, 0.5 * height), rotation, moves)

    @property
    def cap_rotation(self) -> float:
        """Rotation of the cap under the block; 0 where it stands on none that moves apart [rad]."""
        return self.values.get("cap_rotation", 0.0) if self.geometry.stacked else 0.0

    def bearing(self, name: str = "contact_state") -> tuple[bool, bool]:
        """Return whether the left and whether the right end of a base bears."""
        return _ends_in_contact(self.values.get(name, float(ContactState.FULL)))

    def bearing_of(self, body: int) -> tuple[bool, bool]:
        """Return the same for the base of a body of a stack, counted from 0 at the top."""
        if not self.geometry.lower:
            return self.bearing()
        return _ends_in_contact(ContactState.FULL if self.contacts is None else self.contacts[body])

    def _pivot_side(self, rotation: float) -> float:
        """Return -1, 0 or 1 for the left end, the middle or the right end of the cap's base."""
        left, right = self.bearing("soil_contact_state")
        if not (left or right):
            return 0.0
        rate = self.values.get("cap_angular_velocity", 0.0)
        pivot = pivot_of(RESTRAINT_CODES[self.restraint], left, right, rotation, rate)
        return {PIVOT_LEFT: -1.0, PIVOT_RIGHT: 1.0}.get(pivot, 0.0)

    def _displaced(
        self,
        points: Array,
        centre: tuple[float, float],
        rotation: float,
        moves: tuple[float, float],
    ) -> Array:
        right, up = (points - np.array(centre)).T
        across, above = rotated_points(
            right, up, np.array(rotation), small_rotation=self.geometry.small_rotation
        )
        return points + np.column_stack([across + moves[0], above + moves[1]])
