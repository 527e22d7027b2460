"""Assembly: parts and options checked together, and the scene they make."""

import warnings
from collections.abc import Sequence
from functools import cached_property

from rockframe.calls import CheckedCall
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import AssemblyError, ModelWarning, RockframeError
from rockframe.motion import GroundMotion
from rockframe.system.fitting import misfits, missizes
from rockframe.system.options import Coupling, Options, Restraint, Rotation, read_option
from rockframe.system.parts import Parts, sort_parts
from rockframe.system.scenes import SCENES, Scene, Setting
from rockframe.units import ACCELERATION, POSITIVE, QuantityLike, to_si


class Assembly(CheckedCall):
    """Parts and options that have been checked and make a supported scene.

    Two are equal if they have equal parts, in whatever order, and equal options.

    Parameters
    ----------
    *parts
        Components, in any order; a ground motion may be one of them.
    restraint : Restraint or str
        Which point of the base is held horizontally.
    rotation : Rotation or str
        Exact kinematics, or expanded to second order.
    coupling : Coupling or str
        How block, pads, cap and soil are joined, in a scene that has them.
    gravity : str or Quantity, optional
        Acceleration of gravity; standard gravity unless given [m s^-2].

    Raises
    ------
    AssemblyError
        With every fault found; and the supported scenes, if parts are missing or do not
        combine.
    """

    def __init__(
        self,
        *parts: object,
        restraint: Restraint | str = Restraint.CONTACT_STATE,
        rotation: Rotation | str = Rotation.FINITE,
        coupling: Coupling | str = Coupling.COUPLED,
        gravity: QuantityLike | None = None,
    ) -> None:
        faults: list[str] = []
        self.parts: Parts = sort_parts(parts, faults)
        faults += misfits(self.parts)
        # the scenes are of use to one whose parts make none, not to one with a wrong option
        supported = [scene.title for scene in SCENES] if faults else []
        faults += missizes(self.parts)
        self.restraint = read_option(Restraint, restraint, "restraint", faults)
        self.rotation = read_option(Rotation, rotation, "rotation", faults)
        self.coupling = read_option(Coupling, coupling, "coupling", faults)
        self.gravity_si = STANDARD_GRAVITY
        if gravity is not None:
            try:
                self.gravity_si = to_si(
                    gravity, ACCELERATION, owner="System", name="gravity", condition=POSITIVE
                )
            except RockframeError as problem:
                faults.append(str(problem))
        scene = self._find_scene()
        if faults or scene is None:
            raise AssemblyError(faults, supported)
        self.scene: Scene = scene
        for caution in self.setting.cautions():
            warnings.warn(caution, ModelWarning, stacklevel=2)

    def _find_scene(self) -> Scene | None:
        for scene in SCENES:
            if scene.fits(self.parts, self.coupling):
                return scene
        return None

    @property
    def options(self) -> Options:
        """All options, and gravity."""
        return Options(self.restraint, self.rotation, self.coupling, self.gravity_si)

    @cached_property
    def setting(self) -> Setting:
        """The scene's numbers in SI units."""
        return self.scene.make_setting(self.parts, self.options)

    @property
    def motion(self) -> GroundMotion | None:
        """The ground motion among the parts, if there is one."""
        return self.parts.motion

    def describe(self) -> str:
        """Tell which model was picked, by which equations, and what it leaves out.

        Returns
        -------
        str
            Several lines of plain text.
        """
        from rockframe.system.describe import describe

        return describe(self.scene, self.setting, self.parts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Assembly):
            return NotImplemented
        return (self.parts, self.options) == (other.parts, other.options)

    def __hash__(self) -> int:
        return hash((self.parts, self.options))

    def __repr__(self) -> str:
        parts = ", ".join(repr(part) for part in self.parts.given())
        coupling = f", coupling={str(self.coupling)!r}" if self.scene.coupling else ""
        return (
            f"{type(self).__name__}({parts}, restraint={str(self.restraint)!r}, "
            f"rotation={str(self.rotation)!r}{coupling})"
        )

    def to_dict(self) -> dict[str, object]:
        """Give parts and options as plain values, fit for JSON; the motion stands apart.

        Returns
        -------
        dict
        """
        structural: Sequence[object] = [part.to_dict() for part in self.parts.structural()]
        return {
            "parts": structural,
            "restraint": str(self.restraint),
            "rotation": str(self.rotation),
            "coupling": str(self.coupling),
            "gravity": f"{self.gravity_si!r} {ACCELERATION.unit}",
        }
