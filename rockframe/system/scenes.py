"""The table of scenes: which slots make which scene."""

from collections.abc import Callable
from dataclasses import dataclass

from rockframe.errors import AssemblyError
from rockframe.system.alone import AloneSetting
from rockframe.system.bodies import Cap, cap_under, one_body
from rockframe.system.load import Load, load_of
from rockframe.system.options import Coupling, Options
from rockframe.system.parts import Parts
from rockframe.system.rigid_ground import rigid_ground_setting
from rockframe.system.setting import Setting
from rockframe.system.slots import support_of
from rockframe.system.stacked import CascadeSetting, CoupledSetting


@dataclass(frozen=True)
class Scene:
    """A combination of parts that has a model.

    Parameters
    ----------
    title : str
        The parts, as users write them.
    signature : frozenset of str
        Slots of :class:`rockframe.system.parts.Parts` that must be filled.
    make_setting : callable
        From parts and options to the scene's setting.
    coupling : Coupling, optional
        The option that picks this one of two models of the same parts.
    """

    title: str
    signature: frozenset[str]
    make_setting: Callable[[Parts, Options], Setting]
    coupling: Coupling | None = None

    def fits(self, parts: Parts, coupling: Coupling) -> bool:
        """Whether the scene is that of the parts."""
        return self.signature == parts.signature and self.coupling in (None, coupling)


def _on_pads(parts: Parts, options: Options) -> AloneSetting:
    return AloneSetting(support_of(parts.base("pads"), load_of(parts.the_block, options)))


def _on_soil(parts: Parts, options: Options) -> AloneSetting:
    return AloneSetting(support_of(parts.base("soil"), load_of(parts.the_block, options)))


def _with_cap(parts: Parts, options: Options) -> AloneSetting:
    """Put block and cap as one body on the soil."""
    cap = cap_under(parts.the_block, parts.the_cap)
    body = one_body(parts.the_block, cap)
    support = support_of(parts.base("soil"), Load(body, options))
    return AloneSetting(support, cap.half_height - body.centre_height)


def _refuse_twins(parts: Parts, upper: AloneSetting, lower: AloneSetting) -> None:
    """Refuse two bases that show the same column, which would hide one of them."""
    shown = [{column.name for column in each.support.own_law.columns} for each in (upper, lower)]
    twins = sorted(shown[0] & shown[1])
    if twins:
        pads, soil = (type(parts.base(slot)).__name__ for slot in ("pads", "soil"))
        fault = f"{pads} and {soil} both show {' and '.join(twins)}; give those of one other names"
        raise AssemblyError([fault])


def _stack(parts: Parts, options: Options) -> tuple[AloneSetting, AloneSetting, Cap, Options]:
    upper, lower = _on_pads(parts, options), _with_cap(parts, options)
    _refuse_twins(parts, upper, lower)
    return upper, lower, cap_under(parts.the_block, parts.the_cap), options


def _coupled(parts: Parts, options: Options) -> CoupledSetting:
    return CoupledSetting(*_stack(parts, options))


def _cascade(parts: Parts, options: Options) -> CascadeSetting:
    return CascadeSetting(*_stack(parts, options))


_STACK = frozenset({"block", "pads", "cap", "soil"})

SCENES: tuple[Scene, ...] = (
    Scene(
        "Block (on rigid ground; RigidGround(restitution=...) to choose its restitution)",
        frozenset({"block"}),
        rigid_ground_setting,
    ),
    Scene("Block + TwoSpringSupport", frozenset({"block", "pads"}), _on_pads),
    Scene("Block + WinklerSoil", frozenset({"block", "soil"}), _on_soil),
    Scene(
        "Block + CushionCap + WinklerSoil (block and cap as one body)",
        frozenset({"block", "cap", "soil"}),
        _with_cap,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='coupled'",
        _STACK,
        _coupled,
        Coupling.COUPLED,
    ),
    Scene(
        "Block + TwoSpringSupport + CushionCap + WinklerSoil, coupling='cascade'",
        _STACK,
        _cascade,
        Coupling.CASCADE,
    ),
)
