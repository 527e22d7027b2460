"""ASCE 7-22, chapter 13: statics of a component, beside its motion on a floor."""

import math
from collections.abc import Mapping
from typing import Final

from rockframe.codes.check import peaks_of, read_motions, rocking_block, scene_words
from rockframe.components import Block
from rockframe.motion import GroundMotion
from rockframe.proposals import hinted
from rockframe.reports.checks import CheckedLine, CheckedVerdict, CodeCheck
from rockframe.simulation.system import System
from rockframe.units import POSITIVE, QuantityLike, RatioLike, Unit, to_ratio

_OWNER: Final = "asce_7_22"
_CODE: Final = "ASCE/SEI 7-22, chapter 13"
_LEAST: Final = 0.3
_MOST: Final = 1.6
_VERTICAL: Final = 0.2
_RESISTING: Final = 0.9
"""Share of the weight that counts against tipping."""


@hinted()
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
    """Check a component by ASCE 7-22, chapter 13: force, tipping and sliding, beside its motion.

    Parameters
    ----------
    block : Block or System
        The component; or its scene on level rigid ground.
    floor_motions : GroundMotion, or mapping of str to GroundMotion, optional
        Of the floor that it stands on; none for the statics alone.
    spectral_acceleration : float
        S_DS, over gravity [1].
    importance : float, optional
        I_p [1].
    height_factor : float, optional
        H_f, by the height in the building [1].
    ductility_factor : float, optional
        R_mu, of the building [1].
    resonance_factor : float, optional
        C_AR, of the component's table [1].
    strength_factor : float, optional
        R_po, of the component's table [1].
    friction : float, optional
        Coefficient of friction under the component; that of its ground unless given [1].
    free_vibration : str or Quantity, optional
        Still floor after each motion [s].

    Returns
    -------
    CodeCheck
        With a ``report``.

    Raises
    ------
    ComponentError
        Another scene, or a factor that is not above zero.
    UnitsError
        A factor is no pure ratio.

    Examples
    --------
    >>> import rockframe as rf
    >>> cabinet = rf.Block(width="0.6 m", height="1.8 m", mass="300 kg")
    >>> check = rf.codes.asce_7_22(cabinet, spectral_acceleration=1.0, importance=1.5)
    >>> check.passed["tipping"]
    False
    """
    system = System(block) if isinstance(block, Block) else block
    setting = rocking_block(system, _OWNER, slides=True)
    numbers = {
        "S_DS": ("spectral_acceleration", spectral_acceleration),
        "I_p": ("importance", importance),
        "H_f": ("height_factor", height_factor),
        "R_mu": ("ductility_factor", ductility_factor),
        "C_AR": ("resonance_factor", resonance_factor),
        "R_po": ("strength_factor", strength_factor),
    }
    given = {
        symbol: to_ratio(value, owner=_OWNER, name=name, condition=POSITIVE, example="1.5")
        for symbol, (name, value) in numbers.items()
    }
    body, weight = setting.body, setting.body.mass * setting.gravity
    # a wall keeps it from tipping to one side
    arm = body.centre_height * math.tan(min(setting.overturning_angles))
    base = given["S_DS"] * given["I_p"] * weight
    by_formula = 0.4 * base * given["H_f"] / given["R_mu"] * given["C_AR"] / given["R_po"]
    least, most = _LEAST * base, _MOST * base
    force = min(max(by_formula, least), most)
    lifting = _VERTICAL * given["S_DS"] * weight
    pressing, lifted = _RESISTING * weight, max(_RESISTING * weight - lifting, 0.0)
    tipping, resisting = force * body.centre_height, lifted * arm
    anchored = tipping - (pressing - lifting) * arm  # also where F_v lifts it
    newton, moment = Unit.NEWTON, Unit.NEWTON_METRE
    factors = tuple(
        CheckedLine(name, value, Unit.ONE, "factor", "given") for name, value in given.items()
    )
    forces = (
        CheckedLine("W_p", weight, newton, "weight", "of the block"),
        CheckedLine("F_p, formula", by_formula, newton,
                    "0.4 S_DS I_p W_p (H_f/R_mu) (C_AR/R_po)", "13.3-1"),
        CheckedLine("F_p, least", least, newton, "0.3 S_DS I_p W_p", "13.3.1"),
        CheckedLine("F_p, greatest", most, newton, "1.6 S_DS I_p W_p", "13.3.1"),
        CheckedLine("F_p", force, newton, "horizontal force at the centre of mass", "13.3.1"),
        CheckedLine("F_v", lifting, newton,
                    "vertical force at the same time, up or down, 0.2 S_DS W_p", "13.3.1"),
    )  # fmt: skip
    needed = force / lifted if lifted > 0.0 else math.inf
    statics = (
        CheckedLine("M_OT", tipping, moment, "F_p times the height of the centre of mass",
                    "equilibrium"),
        CheckedLine("M_R", pressing * arm, moment, "0.9 W_p times the lesser arm", "equilibrium"),
        CheckedLine("M_R, with F_v", resisting, moment, "0.9 W_p - F_v times the lesser arm",
                    "13.3.1"),
        CheckedLine("M_anchors", max(anchored, 0.0), moment,
                    "what anchors must carry, M_OT - M_R, with F_v", "equilibrium"),
        CheckedLine("mu", force / pressing, Unit.ONE,
                    "friction to stay without anchors, F_p/(0.9 W_p)", "equilibrium"),
        CheckedLine("mu, with F_v", needed, Unit.ONE, "F_p/(0.9 W_p - F_v)", "13.3.1"),
    )  # fmt: skip
    verdicts = [
        CheckedVerdict("tipping", tipping <= resisting,
                       f"M_OT {tipping:.4g} N m, M_R, with F_v {resisting:.4g} N m", "chapter 13")
    ]  # fmt: skip
    there = None if system.parts.ground is None else system.parts.ground.friction
    if friction is not None:
        there = to_ratio(friction, owner=_OWNER, name="friction", condition=POSITIVE, example="0.4")
    if there is not None:
        verdicts.append(
            CheckedVerdict("sliding", needed <= there,
                           f"needed with F_v {needed:.4g}, there is {there:.4g}", "equilibrium")
        )  # fmt: skip
    lines = {"Factors": factors, "Forces": forces, "Statics, without anchors": statics}
    if floor_motions is not None:
        runs = peaks_of(system, read_motions(floor_motions, _OWNER), free_vibration)
        lines["Motion on the floor"] = tuple(
            CheckedLine(label, peak, Unit.RADIAN,
                        "overturned" if overturned else "peak rotation", "run")
            for label, (peak, overturned) in runs.items()
        )  # fmt: skip
        fallen = [label for label, (_, overturned) in runs.items() if overturned]
        verdicts.append(
            CheckedVerdict("motion", not fallen,
                           f"{len(fallen)} of {len(runs)} overturned", "not part of the code")
        )  # fmt: skip
    notes = (
        "H_f, R_mu, C_AR and R_po are taken as they are given",
        "strength of anchors; loads other than earthquake and weight",
    )
    return CodeCheck(
        "A component on its floor", _CODE, lines, tuple(verdicts), notes, scene_words(system)
    )
