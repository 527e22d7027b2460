"""ASCE 7-22, chapter 13: statics of a component, and its computed motion on a floor."""

import math
from collections.abc import Mapping
from typing import Final

from rockframe.codes.check import peak_responses, read_motions, rigid_block_setting, scene_summary
from rockframe.components import Block, RigidGround
from rockframe.motion import GroundMotion
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.simulation.system import System
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, QuantityLike, RatioLike, Unit, to_ratio

_OWNER: Final = "asce_7_22"
_CODE: Final = "ASCE/SEI 7-22, chapter 13"


@with_hints()
def asce_7_22(
    block: Block | System,
    floor_motions: GroundMotion | Mapping[str, GroundMotion] | None = None,
    *,
    spectral_acceleration: RatioLike,
    importance: RatioLike = 1.0,
    height_factor: RatioLike = 1.0,
    ductility_factor: RatioLike = 1.0,
    resonance_factor: RatioLike = 1.0,
    strength_factor: RatioLike = 1.0,
    friction: RatioLike | None = None,
    free_vibration: QuantityLike = "10 s",
) -> CodeCheck:
    """Check a component by ASCE 7-22, chapter 13: force, tipping, sliding and computed motion.

    Parameters
    ----------
    block : Block or System
        The component, or its scene on level rigid ground.
    floor_motions : GroundMotion, or mapping of str to GroundMotion, optional
        Motions of the floor that it stands on. Without them only the statics are checked.
    spectral_acceleration : float
        S_DS, as a multiple of g [1].
    importance : float, optional
        Importance factor I_p [1].
    height_factor : float, optional
        H_f, by the height in the building [1].
    ductility_factor : float, optional
        R_mu of the building [1].
    resonance_factor : float, optional
        C_AR from the table of components [1].
    strength_factor : float, optional
        R_po from the table of components [1].
    friction : float, optional
        Coefficient of friction under the component, on which a `Block` also slides in its motions.
        A scene moves on its own ground, whose friction is the default [1].
    free_vibration : str or Quantity, optional
        Duration for which the run goes on after the end of each motion, on a still floor [s].

    Returns
    -------
    CodeCheck
        The numbers and verdicts. Its method ``report`` writes them as a page.

    Raises
    ------
    ComponentError
        If the scene is another one, or a factor is not positive.
    UnitsError
        If a factor is not dimensionless.

    Examples
    --------
    >>> import rockframe as rf
    >>> cabinet = rf.Block(width="0.6 m", height="1.8 m", mass="300 kg")
    >>> check = rf.codes.asce_7_22(cabinet, spectral_acceleration=1.0, importance=1.5)
    >>> check.passed["tipping"]
    False
    """
    system = System(block) if isinstance(block, Block) else block
    setting = rigid_block_setting(system, _OWNER, allow_sliding=True)
    factors = {
        symbol: to_ratio(value, owner=_OWNER, name=name, condition=POSITIVE, example="1.5")
        for symbol, name, value in (
            ("S_DS", "spectral_acceleration", spectral_acceleration),
            ("I_p", "importance", importance),
            ("H_f", "height_factor", height_factor),
            ("R_mu", "ductility_factor", ductility_factor),
            ("C_AR", "resonance_factor", resonance_factor),
            ("R_po", "strength_factor", strength_factor),
        )
    }
    available_friction = None if system.parts.ground is None else system.parts.ground.friction
    if friction is not None:
        available_friction = to_ratio(
            friction, owner=_OWNER, name="friction", condition=POSITIVE, example="0.4"
        )
    forces = _force_lines(factors, setting.body.mass * setting.gravity)
    # a rear wall prevents tipping to one side
    height, smaller_angle = setting.body.centre_height, min(setting.overturning_angles)
    lines = {
        "Factors": tuple(
            CheckedLine(name, value, Unit.ONE, "factor", "given") for name, value in factors.items()
        ),
        "Forces": forces,
    }
    lines["Statics, without anchors"], verdicts = _check_statics(
        {line.symbol: line.value for line in forces},
        height,
        height * math.tan(smaller_angle),
        available_friction,
    )
    if floor_motions is not None:
        if isinstance(block, Block) and available_friction is not None:
            system = System(block, RigidGround(friction=available_friction))
        runs = peak_responses(system, read_motions(floor_motions, _OWNER), free_vibration)
        lines["Motion on the floor"] = tuple(
            CheckedLine(label, peak.rotation, Unit.RADIAN,
                        "overturned" if peak.overturned else "peak rotation", "run")
            for label, peak in runs.items()
        )  # fmt: skip
        overturned = [label for label, peak in runs.items() if peak.overturned]
        verdicts.append(
            CheckedVerdict("motion", not overturned,
                           f"{len(overturned)} of {len(runs)} overturned", "not part of the code")
        )  # fmt: skip
    notes = (
        "H_f, R_mu, C_AR and R_po are taken as they are given",
        "strength of anchors; loads other than earthquake and weight",
    )
    return CodeCheck(
        "A component on its floor", _CODE, lines, tuple(verdicts), notes, scene_summary(system)
    )


def _force_lines(factors: Mapping[str, float], weight: float) -> tuple[CheckedLine, ...]:
    """Return the seismic forces on a component, equation 13.3-1 and its limits."""
    newton, base = Unit.NEWTON, factors["S_DS"] * factors["I_p"] * weight
    by_formula = 0.4 * base * factors["H_f"] / factors["R_mu"] * factors["C_AR"] / factors["R_po"]
    least, greatest = 0.3 * base, 1.6 * base
    return (
        CheckedLine("W_p", weight, newton, "weight", "of the block"),
        CheckedLine("F_p, formula", by_formula, newton,
                    "0.4 S_DS I_p W_p (H_f/R_mu) (C_AR/R_po)", "13.3-1"),
        CheckedLine("F_p, least", least, newton, "0.3 S_DS I_p W_p", "13.3.1"),
        CheckedLine("F_p, greatest", greatest, newton, "1.6 S_DS I_p W_p", "13.3.1"),
        CheckedLine("F_p", min(max(by_formula, least), greatest), newton,
                    "horizontal force at the centre of mass", "13.3.1"),
        CheckedLine("F_v", 0.2 * factors["S_DS"] * weight, newton,
                    "vertical force at the same time, up or down, 0.2 S_DS W_p", "13.3.1"),
    )  # fmt: skip


def _check_statics(
    forces: Mapping[str, float], height: float, arm: float, friction: float | None
) -> tuple[tuple[CheckedLine, ...], list[CheckedVerdict]]:
    """Return moments and friction without anchors, with verdicts; `arm` is the shorter one [m]."""
    horizontal, moment = forces["F_p"], Unit.NEWTON_METRE
    resisting_weight = 0.9 * forces["W_p"]
    net_weight = max(resisting_weight - forces["F_v"], 0.0)
    tipping, resisting = horizontal * height, net_weight * arm
    # the vertical force may exceed the weight, and then adds to the moment of the anchors
    anchor_moment = tipping - (resisting_weight - forces["F_v"]) * arm
    required_friction = horizontal / net_weight if net_weight > 0.0 else math.inf
    lines = (
        CheckedLine("M_OT", tipping, moment, "F_p times the height of the centre of mass",
                    "equilibrium"),
        CheckedLine("M_R", resisting_weight * arm, moment, "0.9 W_p times the lesser arm",
                    "equilibrium"),
        CheckedLine("M_R, with F_v", resisting, moment, "0.9 W_p - F_v times the lesser arm",
                    "13.3.1"),
        CheckedLine("M_anchors", max(anchor_moment, 0.0), moment,
                    "what anchors must carry, M_OT - M_R, with F_v", "equilibrium"),
        CheckedLine("mu", horizontal / resisting_weight, Unit.ONE,
                    "friction to stay without anchors, F_p/(0.9 W_p)", "equilibrium"),
        CheckedLine("mu, with F_v", required_friction, Unit.ONE, "F_p/(0.9 W_p - F_v)", "13.3.1"),
    )  # fmt: skip
    verdicts = [
        CheckedVerdict("tipping", tipping <= resisting,
                       f"M_OT {tipping:.4g} N m, M_R, with F_v {resisting:.4g} N m", "chapter 13")
    ]  # fmt: skip
    if friction is not None:
        verdicts.append(
            CheckedVerdict("sliding", required_friction <= friction,
                           f"needed with F_v {required_friction:.4g}, there is {friction:.4g}",
                           "equilibrium")
        )  # fmt: skip
    return lines, verdicts
