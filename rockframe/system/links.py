"""Links in a scene: restrainers, tendons, elastic walls and loads, with points, law and words."""

import math
import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from rockframe.components import Link, Load, PointLink, RearWall, Restrainer, Tendon
from rockframe.dynamics.chain.link_rows import ChainLink
from rockframe.dynamics.law_trial import law_faults
from rockframe.dynamics.links import Bumper, LinkNumbers, SteadyForce, Tie
from rockframe.errors import AssemblyError
from rockframe.system.bodies import SupportedBody
from rockframe.system.parts import link_labels


class OwnLink(PointLink):
    """A link with a user-defined law; :func:`rockframe.register` makes its class known.

    A class derived from it declares the parameters of its law, and has the method ``law``.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> from rockframe import extension as ext
    >>> @ext.link_law
    ... class Spring(NamedTuple):
    ...     stiffness: float
    ...
    ...     def force(self, state, stretch, own):
    ...         return self.stiffness * stretch.elongation
    ...
    ...     def energy(self, state, stretch, own):
    ...         return 0.5 * self.stiffness * stretch.elongation**2
    >>> class Bar(ext.OwnLink):
    ...     stiffness = ext.Parameter(
    ...         ext.Measure("a stiffness", ext.Unit.NEWTON_PER_METRE, "2 MN/m"), doc="Stiffness."
    ...     )
    ...
    ...     def law(self, mass):
    ...         stiffness = self.si.stiffness / mass
    ...         return ext.LinkNumbers(Spring(stiffness), stiffness)
    >>> Bar(on=("0 m", "3 m"), to=("1 m", "3 m"), stiffness="2 MN/m").law(1000.0).stiffness
    2000.0
    """

    @abstractmethod
    def law(self, mass: float) -> LinkNumbers:
        """Return the law as the equations take it.

        Parameters
        ----------
        mass : float
            Reference mass of the model; forces, stiffness and damping are divided by it [kg].

        Returns
        -------
        LinkNumbers
        """
        raise NotImplementedError


Point = tuple[float, float]
ROUNDING: Final = 1e-14
"""Distance of two points below which it is zero, over their distance from the lowest base."""


@dataclass(frozen=True)
class PlacedLink:
    """A link between two points of upright bodies, the first called `on`, the second `to`."""

    part: Link  # the link as users gave it
    name: str  # its name in results
    on: int  # body of the first point, numbered from 0 at the top; -1 for the ground
    # place of the first point, to the right of and above the centre of mass of its body, or, on the
    # ground, the middle of the lowest base [m]
    on_point: tuple[float, float]
    to: int  # body and place of the second point, likewise
    to_point: tuple[float, float]
    # both points from the middle of the lowest base [m]
    ends: tuple[tuple[float, float], tuple[float, float]]

    @property
    def vector(self) -> tuple[float, float]:
        """Vector from the second point to the first [m]."""
        (x, y), (to_x, to_y) = self.ends
        return x - to_x, y - to_y

    def numbers(self, mass: float) -> LinkNumbers:
        """Return the law, per unit of a mass [kg]."""
        if isinstance(self.part, Restrainer | Tendon):
            return tie_law(self.part, mass)
        if isinstance(self.part, OwnLink):
            numbers = self.part.law(mass)
            faults = law_faults(numbers)
            if faults:
                raise AssemblyError([f"{self.name}: {fault}" for fault in faults])
            return numbers
        if isinstance(self.part, RearWall):
            bumper = self.part.si
            stiffness, damping = bumper.stiffness / mass, (bumper.damping or 0.0) / mass
            return LinkNumbers(Bumper(stiffness, damping, bumper.gap or 0.0), stiffness, damping)
        return LinkNumbers(SteadyForce(math.hypot(*self.constant_force) / mass), 0.0)

    @property
    def constant_force(self) -> tuple[float, float]:
        """Constant force of a load, to the right and up; zero for any other link [N]."""
        if not isinstance(self.part, Load):
            return 0.0, 0.0
        return self.part.si.horizontal, -self.part.si.vertical

    def chain_link(self, mass: float) -> ChainLink:
        """Return the link as the equations take it."""
        to_point = self.to_point if self.to >= 0 else (0.0, 0.0)
        return ChainLink(
            self.on, self.on_point, self.to, to_point, self.vector, self.numbers(mass),
            self.fixed_direction,
        )  # fmt: skip

    @property
    def fixed_direction(self) -> tuple[float, float]:
        """Fixed direction in which it acts; zero if it acts along the line between its points."""
        if isinstance(self.part, RearWall):
            return self.part.direction, 0.0
        x, y = self.constant_force
        size = math.hypot(x, y) or 1.0
        return -x / size, -y / size

    def words(self) -> str:
        """Describe which points it links, and by which law."""
        (x, y), (to_x, to_y) = self.ends
        if isinstance(self.part, Load):
            right, up = self.constant_force
            return (
                f"on body {self.on + 1} at ({x:.6g}, {y:.6g}) m, {right:.6g} N to the right, "
                f"{-up:.6g} N down"
            )
        if isinstance(self.part, RearWall):
            numbers = self.part.si
            return (
                f"behind body {self.on + 1} at ({x:.6g}, {y:.6g}) m, {numbers.stiffness:.6g} N/m, "
                f"damping {numbers.damping or 0.0:.6g} N s/m, gap {numbers.gap or 0.0:.6g} m; acts "
                "while touched"
            )
        other = "the ground" if self.to < 0 else f"body {self.to + 1}"
        phrases = [
            f"from body {self.on + 1} at ({x:.6g}, {y:.6g}) m to {other} at ({to_x:.6g}, "
            f"{to_y:.6g}) m"
        ]
        if isinstance(self.part, Restrainer | Tendon):
            phrases += tie_law_words(self.part)
        return ", ".join(phrases)


def tie_law_words(part: Restrainer | Tendon) -> list[str]:
    """Describe the law of a restrainer or of a tendon."""
    numbers = part.si
    phrases = [f"{numbers.stiffness:.6g} N/m"]
    phrases += [
        f"{name} {value:.6g} {unit}"
        for name, unit in (("slack", "m"), ("preload", "N"), ("damping", "N s/m"))
        if (value := getattr(numbers, name, None))
    ]
    if numbers.strength is not None:
        verb = "breaks" if numbers.brittle else "yields"
        phrases.append(f"{verb} at {numbers.strength:.6g} N")
    if getattr(numbers, "breaking_elongation", None):
        phrases.append(f"breaks as it is {numbers.breaking_elongation:.6g} m longer")
    pushes = getattr(numbers, "compression", False)
    return [*phrases, "pulls and pushes" if pushes else "pulls only"]


def tie_law(part: Restrainer | Tendon, mass: float) -> LinkNumbers:
    """Return the law of a restrainer, :eq:`eq-tie`, or of a tendon, per unit of a mass [kg]."""
    numbers = part.si
    slack, damping = (getattr(numbers, name, None) or 0.0 for name in ("slack", "damping"))
    stiffness, damping = numbers.stiffness / mass, damping / mass
    free = slack - (numbers.preload or 0.0) / numbers.stiffness
    limit = math.inf if numbers.strength is None else numbers.strength / numbers.stiffness
    breaking = getattr(numbers, "breaking_elongation", None)
    if breaking is not None:
        limit = breaking - free
    pushes = float(getattr(numbers, "compression", False))
    law = Tie(stiffness, damping, free, limit, float(numbers.brittle), pushes)
    size = limit if math.isfinite(limit) else 1.0
    return LinkNumbers(law, stiffness, damping, (size,))


def place_links(
    parts: Sequence[Link],
    bodies: Sequence[SupportedBody],
    tops: Sequence[float],
    offsets: Sequence[float],
) -> tuple[PlacedLink, ...]:
    """Return the places of links on stacked bodies; bodies are listed from the top down."""
    names, faults = link_labels(parts), duplicate_name_faults(parts)
    placed = list[PlacedLink]()
    for part, name in zip(parts, names, strict=True):
        on, to = part.si.on_body - 1, _other_body(part, len(bodies))
        missing = [k + 1 for k in (on, to) if k >= len(bodies)]
        if missing:
            faults += [
                f"{name}: there is no body {k}; bodies are counted from the top down, and there "
                f"{'is 1' if len(bodies) == 1 else f'are {len(bodies)}'}"
                for k in missing
            ]
            continue
        if on == to:
            faults.append(f"{name}: both its points are on body {on + 1}")
            continue
        if isinstance(part, Load) and not (part.si.vertical or part.si.horizontal):
            continue  # its mass has been added to its body
        bases = [(0.0, 0.0) if k < 0 else base_of(k, bodies, tops, offsets) for k in (on, to)]
        ends = _end_points(part, bases[0], bases[1], bodies[on], tops[on])
        if math.dist(*ends) <= ROUNDING * max(abs(place) for end in ends for place in end):
            ends = (ends[0], ends[0])  # they differ by rounding errors of the heights only
        points = [
            (x, y) if k < 0 else
            (x - base[0] - bodies[k].eccentricity, y - base[1] - bodies[k].centre_height)
            for k, (x, y), base in zip((on, to), ends, bases, strict=True)
        ]  # fmt: skip
        far = max(abs(place) for end in ends for place in end)
        if not math.isfinite(far * far * max(getattr(part.si, "stiffness", None) or 1.0, 1.0)):
            faults.append(f"{name}: its moments are larger than a computer's numbers can be")
        link = PlacedLink(part, name, on, points[0], to, points[1], ends)
        if not any(link.vector) and isinstance(part, Restrainer) and part.si.preload:
            faults.append(f"{name}: its points meet, so that its preload has no direction")
        placed.append(link)
    if faults:
        raise AssemblyError(list(dict.fromkeys(faults)))
    return tuple(placed)


def _other_body(part: Link, count: int) -> int:
    """Return the body of a link's other point, counted from 0 at the top; -1 for the ground."""
    if isinstance(part, PointLink):
        return -1 if part.si.to_body is None else part.si.to_body - 1
    # a tendon ends in the body below its own; the other point of a load or wall is on the ground
    return part.si.on_body if isinstance(part, Tendon) and part.si.on_body < count else -1


def _end_points(
    part: Link, base: Point, other: Point, body: SupportedBody, top: float
) -> tuple[Point, Point]:
    """Return both points of a link from the middle of the lowest base [m].

    `base` and `other` are the middles of the bases of its two bodies.
    """
    x, y = base
    if isinstance(part, PointLink):
        (on_x, on_y), (to_x, to_y) = part.si.on, part.si.to
        return (x + on_x, y + on_y), (other[0] + to_x, other[1] + to_y)
    if isinstance(part, Tendon):
        x += part.si.at
        return (x, y), (x, y - part.si.depth)
    if isinstance(part, RearWall):  # where it is touched by the rear face
        y += body.centre_height + top if part.si.height is None else part.si.height
        x += part.direction * body.half_width
        return (x, y), (x + part.direction * (part.si.gap or 0.0), y)
    point = (x + part.si.at[0], y + part.si.at[1])
    return point, point


def axis_name(name: str) -> str:
    """Return the name of a link in axes of sweeps: restrainer_1 for "restrainer 1"."""
    return re.sub(r"\W", "_", name)


def duplicate_name_faults(parts: Sequence[Link]) -> list[str]:
    """Return a fault for each name that several links have."""
    by_axis: dict[str, list[str]] = {}
    for name in link_labels(parts):
        by_axis.setdefault(axis_name(name), []).append(repr(name))
    return [
        f"two links are called {' and '.join(dict.fromkeys(names))}"
        + (f", both {axis} as an axis of a sweep" if len({*names}) > 1 else "")
        for axis, names in by_axis.items()
        if len(names) > 1
    ]


def base_of(
    k: int, bodies: Sequence[SupportedBody], tops: Sequence[float], offsets: Sequence[float]
) -> tuple[float, float]:
    """Return the middle of the base of upright body `k`, from the middle of the lowest base [m]."""
    below = range(k + 1, len(bodies))
    return math.fsum(offsets[k : len(bodies) - 1]), math.fsum(
        bodies[j].centre_height + tops[j] for j in below
    )
