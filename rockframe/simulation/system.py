"""The system that users build and simulate."""

import json
from collections.abc import Mapping, Sequence
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any, Literal, Self

import xarray as xr

from rockframe.arguments import checked_bool, checked_dataset, damage_reported
from rockframe.components import Component, InitialState
from rockframe.errors import ComponentError, ModelWarning, warn
from rockframe.motion import GroundMotion
from rockframe.simulation.provenance import (
    motion_from_dataset,
    parts_and_options,
    system_text,
)
from rockframe.simulation.run_arguments import FOREIGN_ARGUMENTS, Certification
from rockframe.solve.accuracy import AccuracyLevel
from rockframe.suggestions import SuggestingMeta, suggests_names, with_hints
from rockframe.system.assembly import Assembly, assemble
from rockframe.system.options import (
    AccuracyLike,
    Coupling,
    CouplingLike,
    Options,
    Overturning,
    OverturningLike,
    PointsLike,
    Restraint,
    RestraintLike,
    Rotation,
    RotationLike,
    Sliding,
    SlidingLike,
)
from rockframe.system.parts import Parts
from rockframe.system.setting import Setting
from rockframe.units import ACCELERATION, ANGLE, Quantity, QuantityLike, quantity


@suggests_names
class System(metaclass=SuggestingMeta):
    """An assembled scene: parts in any order, checked together, ready to simulate.

    Parameters
    ----------
    *parts
        Components (:class:`~rockframe.Block`, :class:`~rockframe.TwoSpringSupport`,
        :class:`~rockframe.CushionCap`, :class:`~rockframe.WinklerSoil`, ...), in any
        order; a :class:`~rockframe.GroundMotion` may be one of them.
    restraint : {"contact-state", "leading-corner", "centre"}
        Which point of the base the ground holds horizontally.
    rotation : {"finite", "small"}
        Exact kinematics, or expanded to second order in the rotation.
    coupling : {"coupled", "cascade"}
        How block, pads, cap and soil are joined, in a scene that has them.
    gravity : str or Quantity, optional
        Acceleration of gravity; standard gravity unless given [m s^-2].
    inclination : str or Quantity, optional
        Angle by which the base line, of ground, pads, cap and soil alike, rises to the right;
        level unless given. Rotations are then relative to the base line, and displacements,
        velocities, accelerations and forces along and normal to it [rad].
    sliding : {"computed", "checked"}
        Whether bodies slide under the computed friction forces, or are held while the friction
        they need is compared with that of the base. It is always compared in a cascade, on a
        user-defined base, and if a frame, or a block before a stiff wall, stands on the ground.

    Raises
    ------
    AssemblyError
        Parts or options do not fit, or the block falls by its own weight. The message lists all
        faults, and the supported scenes if parts are missing or do not combine.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
    >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
    >>> response = rf.System(block, pads).simulate(
    ...     rf.GroundMotion.sine_pulse(amplitude="-3 m/s^2"), free_vibration="2 s"
    ... )
    >>> bool(response.overturned)
    False
    """

    __slots__ = ("_assembly",)
    _assembly: Assembly

    def __init__(
        self,
        *parts: object,
        restraint: RestraintLike = Restraint.CONTACT_STATE,
        rotation: RotationLike = Rotation.FINITE,
        coupling: CouplingLike = Coupling.COUPLED,
        gravity: QuantityLike | None = None,
        inclination: QuantityLike | None = None,
        sliding: SlidingLike = Sliding.COMPUTED,
    ) -> None:
        self._assembly = assemble(
            parts, restraint=restraint, rotation=rotation, coupling=coupling, gravity=gravity,
            inclination=inclination, sliding=sliding,
        )  # fmt: skip
        for caution in self._assembly.setting_cautions:
            warn(caution, ModelWarning)

    @property
    def assembly(self) -> Assembly:
        """Parts and options, checked together."""
        return self._assembly

    @property
    def parts(self) -> Parts:
        """The parts, by what they are."""
        return self._assembly.parts

    @property
    def motion(self) -> GroundMotion | None:
        """The ground motion among the parts, if there is one."""
        return self.parts.motion

    @property
    def options(self) -> Options:
        """All options, and gravity."""
        return self._assembly.options

    @property
    def restraint(self) -> Restraint:
        """Which point of the base the ground holds horizontally."""
        return self.options.restraint

    @property
    def rotation(self) -> Rotation:
        """Exact kinematics, or expanded to second order in the rotation."""
        return self.options.rotation

    @property
    def coupling(self) -> Coupling:
        """How block, pads, cap and soil are joined, in a scene that has them."""
        return self.options.coupling

    @property
    def gravity(self) -> Quantity:
        """Acceleration of gravity [m s^-2]."""
        return quantity(self.options.gravity, ACCELERATION)

    @property
    def inclination(self) -> Quantity:
        """Angle by which the base line rises to the right [rad]."""
        return quantity(self.options.inclination, ANGLE)

    @property
    def sliding(self) -> Sliding:
        """What friction does: its forces are computed, or it is compared with what is needed."""
        return self.options.sliding

    @property
    def setting(self) -> Setting:
        """The scene's numbers in SI units."""
        return self._assembly.setting

    def __eq__(self, other: object) -> bool:
        return self._assembly == other._assembly if isinstance(other, System) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._assembly)

    def __repr__(self) -> str:
        hidden = {"gravity"} if self._assembly.scene.coupling else {"gravity", "coupling"}
        options = self.options.to_dict().items()
        arguments = [f"{name}={value!r}" for name, value in options if name not in hidden]
        return f"{type(self).__name__}({', '.join([*map(repr, self.parts), *arguments])})"

    def __dir__(self) -> list[str]:
        inner = {"assembly", "setting"}  # for the package, and those who extend it
        return [n for n in super().__dir__() if not n.startswith("_") and n not in inner]

    def _repr_html_(self) -> str:
        from rockframe.system.geometry import system_html

        return system_html(self._assembly, type(self).__name__)

    def describe(self) -> str:
        """Describe the model that the parts make: its equations, its numbers and its limits.

        Returns
        -------
        str
            Several lines of plain text.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
        >>> system.describe().splitlines()[0]
        'Model: rigid ground'
        """
        return self._assembly.description

    @with_hints(**FOREIGN_ARGUMENTS)
    def simulate(
        self,
        motion: GroundMotion | None = None,
        *,
        duration: QuantityLike | None = None,
        free_vibration: QuantityLike | None = None,
        initial: InitialState | xr.Dataset | None = None,
        accuracy: AccuracyLike = AccuracyLevel.STANDARD,
        output_step: QuantityLike | None = None,
        outputs: Sequence[str] | None = (),
        points: PointsLike | None = None,
        overturning: OverturningLike = Overturning.STOP,
        certify: "bool | Certification | Literal['proved']" = False,
        second_look: bool = True,
    ) -> xr.Dataset:
        """Integrate the equations of motion.

        Parameters
        ----------
        motion : GroundMotion, optional
            Motion of the ground; the one among the parts unless given.
        duration : str or Quantity, optional
            Length of the run; the motion's unless given. Beyond the motion the
            ground stands still [s].
        free_vibration : str or Quantity, optional
            Time added to the motion's length, instead of `duration` [s].
        initial : InitialState or xarray.Dataset, optional
            Initial state; at rest unless given. With the result of another run of this system,
            the run starts from the end of that run, and time starts at zero again.
        accuracy : {"fast", "standard", "reference"}, float or Accuracy
            Accuracy, and thus cost, of the run.
        output_step : str or Quantity, optional
            Spacing of the histories; the motion's time step unless given [s].
        outputs : sequence of str, optional
            Histories beyond those that every run has: names such as ``"friction_demand"``
            or ``"toe_pressure"``, and the groups ``"acceleration"``, ``"reaction"``,
            ``"impulse"`` and ``"energy"``. None keeps no histories at all, only events
            and scalars.
        points : mapping of str to (str or Quantity, str or Quantity), optional
            Points of the body, by any names: distances at rest to the right of the middle of
            its base and above it. Their displacements and absolute accelerations are given
            over ``point`` and ``time``, and the peaks of these over ``point``, even if
            `outputs` is None [m].
        overturning : {"stop", "continue"}
            Whether the run ends when the rotation reaches the overturning
            angle, or continues until the block lies flat.
        certify : bool, Certification or "proved"
            Whether to assess the certainty of the verdict by about a hundred further runs, with
            higher accuracy, slightly changed parameters and scaled motions; or ``"proved"``, to
            prove the verdict as :func:`rockframe.prove` does.
        second_look : bool
            Whether a run with ``accuracy="fast"`` is repeated with 1.5 times as many steps and
            without histories, to check its verdict and its peak rotation. Runs of other
            accuracies, and runs that are certified, are not repeated.

        Returns
        -------
        xarray.Dataset
            Histories over ``time``, events over ``event``, and scalars; also for
            an unfinished run, which its ``status`` indicates.

        Raises
        ------
        UnitsError
            An argument has the wrong unit, or none.
        AssemblyError
            The arguments do not fit the system or one another.
        SolverError
            Unknown accuracy, or a tolerance out of range.
        ComponentError
            `certify` is not True, False, ``"proved"`` or a Certification; or nothing can be
            proved about the system.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
        >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
        >>> run = system.simulate(pulse, free_vibration="2 s")
        >>> f"{float(run.peak_relative_rotation):.2f}, overturned: {bool(run.overturned)}"
        '0.28, overturned: False'
        """
        from rockframe.simulation.plan import plan_run, read_certification
        from rockframe.simulation.run import run

        plan = plan_run(
            self._assembly, motion, duration=duration, free_vibration=free_vibration,
            initial=initial, accuracy=accuracy, output_step=output_step, outputs=outputs,
            points=points, overturning=overturning,
        )  # fmt: skip
        again = checked_bool(second_look, owner="simulate", name="second_look")
        return run(self._assembly, plan, read_certification(certify), repeat_run=again)

    def to_opensees(self, motion: GroundMotion, path: str | Path, **options: Any) -> Path:
        """Write the system and a motion as a Python file that OpenSees runs.

        Parameters
        ----------
        motion : GroundMotion
            The motion.
        path : str or Path
            Path of the file; its name ends in ``.py``.
        **options
            Options of :func:`rockframe.export.to_opensees`, which this calls.

        Returns
        -------
        Path

        Raises
        ------
        ComponentError, FileError
            As :func:`rockframe.export.to_opensees`.

        Examples
        --------
        >>> import tempfile
        >>> import rockframe as rf
        >>> block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
        >>> system = rf.System(block, rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1))
        >>> pulse = rf.GroundMotion.sine_pulse("1.6 m/s^2", "1 Hz")
        >>> system.to_opensees(pulse, f"{tempfile.mkdtemp()}/model.py").name
        'model.py'
        """
        above: Any = import_module("rockframe.export")  # from a layer above this one
        return above.to_opensees(self, motion, path, **options)

    def frequencies(self) -> xr.Dataset:
        """Return the modes of small motion about rest, in full contact.

        Returns
        -------
        xarray.Dataset
            Over ``mode``, from slow to fast: angular and cyclic frequency and
            period without damping, damping ratio, and the shape in displacements
            of block and cap. NaN where a mode does not return to rest.

        Raises
        ------
        AssemblyError
            The block stands on rigid ground, where there is no small motion.

        Examples
        --------
        >>> import rockframe as rf
        >>> block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
        >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
        >>> rf.System(block, pads, gravity="9.81 m/s^2").frequencies().period.values.round(4)
        array([1.2401, 0.259 ])
        """
        from rockframe.simulation.statics import frequencies

        return frequencies(self._assembly)

    def moment_rotation(self, angles: object) -> xr.Dataset:
        """Return the moments that hold the body at given rotations in vertical equilibrium.

        Parameters
        ----------
        angles : (sequence, unit), Quantity or sequence of str
            Rotations of the body, on cap and soil together [rad].

        Returns
        -------
        xarray.Dataset
            Over ``angle``: restoring moment, moment of the base, vertical
            displacement, contact state and reactions.

        Raises
        ------
        UnitsError
            The angles have no unit, or not that of an angle.

        Examples
        --------
        >>> import rockframe as rf
        >>> soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
        >>> system = rf.System(rf.Block(width="4 m", height="18 m", mass="99 t"), soil)
        >>> held = system.moment_rotation(([0.0, 0.01, 0.1], "rad"))
        >>> [round(float(length), 3) for length in held.held_contact_length]
        [4.0, 4.0, 1.47]
        """
        from rockframe.simulation.statics import moment_rotation

        return moment_rotation(self._assembly, angles)

    def equilibrium(self) -> xr.Dataset:
        """Return settlements and reactions at rest, and where full contact ends.

        Returns
        -------
        xarray.Dataset
            Scalars: settlements and reactions of the parts of the scene,
            ``uplift_angle``, ``uplift_moment`` and ``overturning_angle``.

        Examples
        --------
        >>> import rockframe as rf
        >>> soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
        >>> system = rf.System(rf.Block(width="4 m", height="18 m", mass="99 t"), soil)
        >>> round(float(system.equilibrium().soil_settlement), 4)
        0.027
        """
        from rockframe.simulation.statics import equilibrium

        return equilibrium(self._assembly)

    def to_dict(self) -> dict[str, object]:
        """Return parts, options and gravity as plain values, fit for JSON.

        Returns
        -------
        dict
            A motion among the parts is stored under ``motion``: a pulse or a synthetic motion
            by its parameters, a record by its samples.

        Examples
        --------
        >>> import rockframe as rf
        >>> rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t")).to_dict()["parts"]
        [{'type': 'Block', 'width': '0.8 m', 'height': '4.0 m', 'mass': '2000.0 kg'}]
        """
        motion = {} if self.motion is None else {"motion": self.motion.to_dict(samples=True)}
        return {**self._assembly.to_dict(), **motion}

    @classmethod
    def from_dict(cls, description: Mapping[str, Any]) -> Self:
        """Build the system that :meth:`to_dict` described.

        Parameters
        ----------
        description : mapping
            As written by :meth:`to_dict`, or read as ``system_json`` from a result.

        Returns
        -------
        System

        Raises
        ------
        SchemaError
            The description is not one of a system.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"), sliding="checked")
        >>> rf.System.from_dict(system.to_dict()) == system
        True
        """
        with damage_reported("this does not describe a system"):
            parts, options = parts_and_options(description, signature(cls).parameters)
            return cls(*parts, **options)

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> Self:
        """Build the system that a result came from.

        Parameters
        ----------
        dataset : xarray.Dataset
            A result of :meth:`simulate`, also one read back from a file.

        Returns
        -------
        System
            With the ground motion of the result among its parts, if the dataset
            contains enough of it (always for analytic pulses; for records if the
            histories have the time step of the record).

        Raises
        ------
        SchemaError
            Not a dataset, or one that does not describe a system; or a case selected from a
            sweep over parameters, whose system :func:`rockframe.case` returns.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
        >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
        >>> rf.System.from_dataset(run).motion.name
        'sine pulse, 2.5 m/s^2, 1 Hz, cycles: 1'
        """
        owner = f"{cls.__name__}.from_dataset"
        text = system_text(checked_dataset(dataset, owner=owner), owner=owner)
        with damage_reported("the dataset's attributes 'motion...' do not describe a motion"):
            motion = motion_from_dataset(dataset)
        with damage_reported("the dataset's attribute 'system_json' does not describe a system"):
            parts, options = parts_and_options(json.loads(text), signature(cls).parameters)
            return cls(*parts, *([] if motion is None else [motion]), **options)


def check_system(value: object, owner: str) -> None:
    """Refuse anything but a System."""
    if not isinstance(value, System):
        msg = f"{owner}: system needs a System, got {type(value).__name__}{system_hint(value)}"
        raise ComponentError(msg)


def system_hint(value: object) -> str:
    """Show at the end of a message how a system is made of a component; empty for other values."""
    return "; write rf.System(block, ...)" if isinstance(value, Component) else ""
