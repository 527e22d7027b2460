"""The immutable value behind a system: parts and options, checked together."""

from rockframe.motion import GroundMotion
from rockframe.suggestions import SuggestingMeta, suggests_names
from rockframe.system.assembly import Assembly, Scene
from rockframe.system.options import Coupling, Options, Restraint, Rotation, Sliding
from rockframe.system.parts import Parts
from rockframe.system.setting import Setting
from rockframe.units import ACCELERATION, ANGLE, Quantity, quantity


@suggests_names
class SystemValue(metaclass=SuggestingMeta):
    """The parts and options of a system, without its methods that simulate."""

    __slots__ = ("_assembly",)

    _assembly: Assembly

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
    def scene(self) -> Scene:
        """The row of the table of scenes that the parts make."""
        return self._assembly.scene

    @property
    def setting(self) -> Setting:
        """The scene's numbers in SI units."""
        return self._assembly.setting

    def __eq__(self, other: object) -> bool:
        return (
            self._assembly == other._assembly if isinstance(other, SystemValue) else NotImplemented
        )

    def __hash__(self) -> int:
        return hash(self._assembly)

    def __repr__(self) -> str:
        parts = ", ".join(repr(part) for part in self.parts)
        coupling = f", coupling={str(self.coupling)!r}" if self.scene.coupling else ""
        value = self.options.to_dict()
        others = "".join(
            f", {name}={value[name]!r}" for name in ("inclination", "sliding") if name in value
        )
        return (
            f"{type(self).__name__}({parts}, restraint={str(self.restraint)!r}, "
            f"rotation={str(self.rotation)!r}{coupling}{others})"
        )

    def __dir__(self) -> list[str]:
        inner = {"assembly", "scene", "setting"}  # for the package, and those who extend it
        return [n for n in super().__dir__() if not n.startswith("_") and n not in inner]

    def _repr_html_(self) -> str:
        from rockframe.system.geometry import system_html

        return system_html(self._assembly, type(self).__name__)
