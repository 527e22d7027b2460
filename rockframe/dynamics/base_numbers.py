"""What is known of a base before a run: its law, its sizes, and what it shows."""

import math
from dataclasses import dataclass, field

import numpy as np

from rockframe.compiled import Integers, Vector
from rockframe.dynamics.base import Base
from rockframe.dynamics.bed import Bed
from rockframe.dynamics.body import Body
from rockframe.dynamics.events import ContactState
from rockframe.dynamics.on_base import SLIDES, STANDINGS
from rockframe.dynamics.pads import LEAVE, REENGAGE, ROUNDING, Pads
from rockframe.dynamics.protocol import Column


@dataclass(frozen=True)
class BaseNumbers:
    """A base under a body, per unit mass.

    Parameters
    ----------
    law : Base
        Its equations.
    columns : tuple of Column
        What it writes for users to see.
    settlement : float
        Under the weight [m].
    vertical_stiffness, rotational_stiffness : float
        In full contact, of its middle [s^-2], [m^2 s^-2].
    damping_time : float
        Bound of damping over stiffness [s].
    end_tolerance : ndarray, shape (guards of an end,)
        Rounding noise of the guards.
    variable_scales : ndarray, shape (variables,)
        Typical sizes of its own variables.
    """

    law: Base
    columns: tuple[Column, ...]
    settlement: float
    vertical_stiffness: float
    rotational_stiffness: float
    damping_time: float
    end_tolerance: Vector
    variable_scales: Vector = field(default_factory=lambda: np.zeros(0))


def pads_under(
    body: Body, *, stiffness: float, damping: float, restitution: tuple[float, float]
) -> BaseNumbers:
    """Give the pads under a body.

    Parameters
    ----------
    body : Body
        The body on them.
    stiffness, damping : float
        k and c of one pad over the body's mass [s^-2], [s^-1].
    restitution : tuple of float
        eps of a corner that lands on the left and on the right pad [1].

    Returns
    -------
    BaseNumbers
    """
    rest = 0.5 * body.gravity / stiffness
    size = math.hypot(0.5 * (body.left + body.right), body.height)
    law = Pads(
        stiffness, damping, rest, rest, rest, *restitution, gravity=body.gravity, body_size=size
    )
    tolerance = np.full(law.end_guards(), ROUNDING)
    tolerance[[LEAVE, REENGAGE]] = law.noise()
    return BaseNumbers(
        law,
        (Column("left_reaction", per_mass=True), Column("right_reaction", per_mass=True)),
        settlement=rest,
        vertical_stiffness=2.0 * stiffness,
        rotational_stiffness=stiffness * (body.left**2 + body.right**2),
        damping_time=damping / stiffness,
        end_tolerance=tolerance,
    )


def bed_under(
    body: Body, *, stiffness: float, damping: float, by_pressure: bool, load: float = 1.0
) -> BaseNumbers:
    """Give the bed under a body.

    Parameters
    ----------
    body : Body
        The body on it.
    stiffness, damping : float
        k0 and c0 per length of base, over the mass that all is measured by [m^-1 s^-2],
        [m^-1 s^-1].
    by_pressure : bool
        Whether the bed lets go where its pressure would be negative, too.
    load : float
        Mass on the bed over that mass [1].

    Returns
    -------
    BaseNumbers
    """
    width = body.left + body.right
    settlement = load * body.gravity / (width * stiffness)
    size = math.hypot(0.5 * width, body.height)
    return BaseNumbers(
        Bed(stiffness, damping, settlement, width, by_pressure),
        (
            Column("soil_reaction", per_mass=True),
            Column("contact_length"),
            Column("toe_pressure", per_mass=True),
        ),
        settlement=settlement,
        vertical_stiffness=width * stiffness,
        rotational_stiffness=stiffness * (body.left**3 + body.right**3) / 3.0,
        damping_time=damping / stiffness,
        end_tolerance=np.array([ROUNDING * (1.0 + size / settlement)]),
    )


@dataclass(frozen=True)
class ModeTable:
    """What the modes of a body on a base mean.

    Parameters
    ----------
    contact : ndarray of int64, shape (modes,)
        :class:`rockframe.dynamics.events.ContactState` of each.
    slides : ndarray of bool, shape (modes,)
        Whether an end slides.
    """

    contact: Integers
    slides: Vector

    @property
    def free(self) -> Vector:
        """Whether nothing holds the body horizontally, shape (modes,)."""
        return self.slides | (self.contact == ContactState.FLIGHT)


def mode_table(law: Base) -> ModeTable:
    """Give the table of a base; it is that of its class."""
    kind = type(law)
    if kind not in _TABLES:
        left = np.array([not law.is_held(contact, True) for contact in range(law.contacts())])
        right = np.array([not law.is_held(contact, False) for contact in range(law.contacts())])
        contact = np.full(law.contacts(), ContactState.FULL, dtype=np.int64)
        contact[left] = ContactState.RIGHT
        contact[right] = ContactState.LEFT
        contact[left & right] = ContactState.FLIGHT
        slides = np.arange(STANDINGS * law.contacts()) & SLIDES != 0
        _TABLES[kind] = ModeTable(np.repeat(contact, STANDINGS), slides)
    return _TABLES[kind]


_TABLES: dict[type, ModeTable] = {}
