"""The system that users build and simulate."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Self

import xarray as xr

from rockframe.arguments import checked_dataset
from rockframe.calls import public_names
from rockframe.components import InitialState, component_from_dict
from rockframe.errors import SchemaError
from rockframe.motion import GroundMotion
from rockframe.solve.accuracy import Accuracy, AccuracyLevel
from rockframe.system.assembly import Assembly
from rockframe.units import QuantityLike

if TYPE_CHECKING:
    from rockframe.simulation.certification import Certification


@public_names
class System(Assembly):
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

    Raises
    ------
    AssemblyError
        With every fault found at once; and the supported scenes, if parts are missing or do
        not combine.

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

    def simulate(
        self,
        motion: GroundMotion | None = None,
        *,
        duration: QuantityLike | None = None,
        free_vibration: QuantityLike | None = None,
        initial: "InitialState | xr.Dataset | None" = None,
        accuracy: Accuracy | str | float = AccuracyLevel.STANDARD,
        output_step: QuantityLike | None = None,
        outputs: Sequence[str] | None = (),
        overturning: str = "stop",
        certify: "bool | Certification" = False,
    ) -> xr.Dataset:
        """Integrate the equations of motion.

        Parameters
        ----------
        motion : GroundMotion, optional
            The ground's motion; the one among the parts unless given.
        duration : str or Quantity, optional
            Length of the run; the motion's unless given. Beyond the motion the
            ground stands still [s].
        free_vibration : str or Quantity, optional
            Time added to the motion's length, instead of `duration` [s].
        initial : InitialState or xarray.Dataset, optional
            Where the run starts; at rest unless given. The result of another run of this
            system starts it where that one ended, its time at zero again.
        accuracy : {"fast", "standard", "reference"}, float or Accuracy
            How accurate, and so how costly, the run is.
        output_step : str or Quantity, optional
            Spacing of the histories; the motion's time step unless given [s].
        outputs : sequence of str, optional
            Histories beyond those every run has: names such as
            ``"kinetic_energy"``, or ``"energy"`` for all energies. None keeps
            no histories at all, only events and scalars.
        overturning : {"stop", "continue"}
            Whether the run ends when the rotation reaches the overturning
            angle, or goes on until the block lies flat.
        certify : bool or Certification
            Whether some hundred runs beside this one, by finer means, with nudged
            parameters and scaled motions, tell how sure the verdict is.

        Returns
        -------
        xarray.Dataset
            Histories over ``time``, events over ``event``, and scalars; also of
            a run that could not be finished, as its ``status`` tells.

        Raises
        ------
        UnitsError
            An argument has the wrong unit, or none.
        AssemblyError
            The arguments do not fit the system or one another.
        SolverError
            Unknown accuracy, or a tolerance out of range.
        ComponentError
            `certify` is neither True, False nor a Certification.
        """
        from rockframe.simulation.certification import certification_of
        from rockframe.simulation.plan import plan_run
        from rockframe.simulation.run import run

        plan = plan_run(
            self,
            motion,
            duration=duration,
            free_vibration=free_vibration,
            initial=initial,
            accuracy=accuracy,
            output_step=output_step,
            outputs=outputs,
            overturning=overturning,
        )
        return run(self, plan, certification_of(certify))

    def frequencies(self) -> xr.Dataset:
        """Give the modes of small motion about rest, in full contact.

        Returns
        -------
        xarray.Dataset
            Over ``mode``, from slow to fast: angular and cyclic frequency and
            period without damping, damping ratio, and the shape in displacements
            of block and cap. NaN where a mode does not return to rest.

        Raises
        ------
        AssemblyError
            The block stands on rigid ground, which leaves no small motion.

        Examples
        --------
        >>> import rockframe as rf
        >>> block = rf.Block.from_size(radius="5 m", slenderness=4, mass="50 t")
        >>> pads = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
        >>> rf.System(block, pads, gravity="9.81 m/s^2").frequencies().period.values.round(4)
        array([1.2401, 0.259 ])
        """
        from rockframe.simulation.statics import frequencies

        return frequencies(self)

    def moment_rotation(self, angles: object) -> xr.Dataset:
        """Give the moments that hold the body at given rotations, in vertical equilibrium.

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

        return moment_rotation(self, angles)

    def equilibrium(self) -> xr.Dataset:
        """Give settlements and reactions at rest, and where full contact ends.

        Returns
        -------
        xarray.Dataset
            Scalars: settlements and reactions of what the scene has,
            ``uplift_angle``, ``uplift_moment`` and ``overturning_angle``.
        """
        from rockframe.simulation.statics import equilibrium

        return equilibrium(self)

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
            With the result's ground motion among its parts, where the dataset
            holds enough of it (analytic pulses always; records where the
            histories have the record's own time step).

        Raises
        ------
        SchemaError
            No dataset, or one that does not describe a system.
        """
        from rockframe.simulation.provenance import motion_from_dataset

        dataset = checked_dataset(dataset, owner=f"{cls.__name__}.from_dataset")
        text = dataset.attrs.get("system_json")
        if not isinstance(text, str):
            msg = "the dataset has no attribute 'system_json'; expected a result of simulate()"
            raise SchemaError(msg)
        try:
            description = json.loads(text)
            parts = [component_from_dict(part) for part in description.pop("parts")]
            options = {name: str(value) for name, value in description.items()}
            motion = motion_from_dataset(dataset)
            return cls(*parts, *([] if motion is None else [motion]), **options)
        except (ValueError, KeyError, TypeError, AttributeError) as problem:
            msg = f"the dataset's attributes do not describe a system: {problem}"
            raise SchemaError(msg) from problem
