"""User-defined scenes: the base class of a scene with its own equations."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NoReturn

from rockframe.components import Component
from rockframe.dynamics.protocol import BODY_COLUMNS, POWERS, ContactModel, Ground, Start
from rockframe.errors import AssemblyError
from rockframe.system.own_base import OwnAnswers
from rockframe.system.parts import Parts
from rockframe.system.setting import Setting
from rockframe.system.statics import Statics


@dataclass(frozen=True)
class OwnScene(OwnAnswers, Setting):
    """A user-defined scene with its own equations.

    A subclass has the attributes ``made_of``, its parts, and ``model``, the name of its model, and
    the methods ``contact_model``, which gives the equations, and ``words``, for `describe()`.
    Everything else has a default. If a user requests something that the scene does not define,
    such as its statics, an error is raised. :func:`rockframe.register` makes the scene known.

    Parameters
    ----------
    load : BaseLoad
        The block, with the options of its system.
    parts : Parts
        The parts, by their slots: ``self.parts["block"]``.
    """

    parts: Parts
    made_of: ClassVar[Mapping[str, type[Component]]] = {}
    """Slots and classes of the parts, one of them a block; shipped parts fill their own slots."""

    def misfits(self) -> list[str]:
        """Return the faults of parts and options; none unless overridden.

        Returns
        -------
        list of str
            Each names what does not fit, and a remedy.
        """
        return []

    @cached_property
    def uplift_angle(self) -> float:
        """Rotation at which full contact is lost; NaN, for unknown, unless overridden [rad]."""
        return math.nan

    @cached_property
    def overturning_energy(self) -> float:
        """Energy needed to overturn the body; 0, for unknown, without `curve` [J].

        With 0 no run warns that the body may still overturn after the end of the run.
        """
        if type(self).curve is OwnScene.curve:
            return 0.0
        return super().overturning_energy

    def curve(self, rotations: Sequence[float]) -> list[Statics | None]:
        """Return the quasi-static states at rotations [rad]; refused unless overridden."""
        self._raise_undefined("has no quasi-static states", "curve(rotations)")

    def equilibrium(self) -> dict[str, float]:
        """Return settlements and reactions at rest; refused unless overridden."""
        self._raise_undefined("has no state of rest", "equilibrium()")

    def without_small_motion(self) -> str:
        """Say that the scene does not give equations of small motion."""
        return f"{self.model} has no small motion; its class must define small_motion()"

    def start_faults(self, rotation: float, has_vertical_start: bool) -> list[str]:
        """Refuse a vertical start, unless overridden."""
        if not has_vertical_start:
            return []
        sentence = "InitialState: vertical_displacement and vertical_velocity are no start of "
        return [f"{sentence}{self.model}"]

    def _raise_undefined(self, words: str, method: str) -> NoReturn:
        raise AssemblyError([f"{self.model} {words}; its class must define {method}"])

    def compile(self) -> ContactModel:
        """Return the equations, ready for the integrator.

        Raises
        ------
        AssemblyError
            Sizes of the model do not fit its system; all faults are listed.
        """
        model = super().compile()
        faults = _size_mismatches(model)
        if faults:
            raise AssemblyError([f"{type(self).__name__}: {fault}" for fault in faults])
        return model


def _size_mismatches(model: ContactModel) -> list[str]:
    """Compare the sizes of a model's tables with what its system gives at the start."""
    system, size, ground = model.system, model.system.coordinates(), Ground(0.0, 0.0)
    width = 2 * size + system.variables()
    mode, state, memory = model.initial(Start())
    faults: list[str] = []
    if model.columns[: len(BODY_COLUMNS)] != BODY_COLUMNS:
        faults.append("columns must begin with BODY_COLUMNS, of the block")
    counts = [
        ("the state of initial(start)", len(state), width),
        ("memory of initial(start)", len(memory), len(model.memory)),
        ("scales", len(model.scales), width),
        ("rotation_weights", len(model.rotation_weights), size),
        ("guard_tolerance", len(model.guard_tolerance), system.guards()),
    ]
    if not any(found != required for _, found, required in counts[:2]):
        slope = system.accelerate(mode, state, ground)
        counts.append(("accelerate", len(slope), width - size + POWERS))
        if len(slope) == width - size + POWERS:
            guards = system.guards_in(mode, state, slope, ground)
            columns = system.observe(mode, state, slope, ground, memory)
            counts += [
                ("guards_in: values", len(guards.values), system.guards()),
                ("guards_in: changes", len(guards.changes), system.guards()),
                ("observe", len(columns), len(model.columns)),
            ]
    faults += [
        f"{what} has {found} numbers, but there must be {required}"
        for what, found, required in counts
        if found != required
    ]
    return faults
