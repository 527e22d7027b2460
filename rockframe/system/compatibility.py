"""Whether parts fit one another: faults, contradictions, options without effect."""

import math
from inspect import getattr_static
from typing import Final

from rockframe.case_arrays import isfinite
from rockframe.components import (
    Component,
    Load,
    PointLink,
    RearWall,
    Restrainer,
    RigidGround,
    Stack,
    Tendon,
)
from rockframe.components.block_numbers import BlockSI, squat_body_warnings
from rockframe.system.options import Coupling, Options, Restraint, Sliding
from rockframe.system.own_base import OwnBase
from rockframe.system.parts import Parts, base_friction, slot_of_class
from rockframe.system.rear_wall import IMPACT_TIME, equivalent_wall

_ROUNDING = 1e-12
BASE_SLOTS = ("pads", "soil", "ground")
"""Slots of bases that bodies of a stack may stand on."""
_DEPTH_TOLERANCE = 1e-9
_EDGE_TOLERANCE: Final = 1.01
"""Ratio up to which a point counts as inside a size: certificates change sizes a little."""


def combination_faults(parts: Parts) -> list[str]:
    """Return the faults of a combination of parts of any sizes."""
    block, pads, cap, soil = parts.block, parts.pads, parts.cap, parts.soil
    faults: list[str] = []
    if parts.own:  # parts of a user's own scene, which checks them itself
        return ["no Block is given"] if block is None else []
    if parts.stack is not None:
        faults += _stack_faults(parts.stack, parts)
    elif parts.frame is not None:
        faults += _frame_faults(parts)
    elif block is None:
        faults.append("no Block is given")
    if parts.ground is not None and (others := _class_names(pads, cap, soil)):
        faults.append(
            f"RigidGround and {others} are both given; rigid ground carries a block directly"
        )
    if parts.rigid_wall is not None:
        faults += _stiff_wall_faults(parts.rigid_wall, parts)
    if parts.links and parts.frame is None:
        faults += _link_faults(parts)
    if cap is not None and soil is None:
        faults.append("a CushionCap is given without a WinklerSoil for it to stand on")
    if pads is not None and soil is not None and cap is None and parts.stack is None:
        faults.append(
            f"a {type(pads).__name__} and a {type(soil).__name__} are given without a CushionCap; "
            "the cap carries the pads and spreads their reactions over the soil"
        )
    for part in parts.components.values():
        if isinstance(part, OwnBase):
            faults += part.misfits(parts.components)
    return faults


def _class_names(*parts: Component | None) -> str:
    """Join the names of the classes of those parts that there are."""
    return " and ".join(type(part).__name__ for part in parts if part is not None)


def _stiff_wall_faults(wall: RearWall, parts: Parts) -> list[str]:
    """Return the faults of a stiff wall with other parts: its laws are impacts on rigid ground."""
    base = parts.pads or parts.soil
    links = [link for link in parts.links if not isinstance(link, RearWall)]
    others = _class_names(parts.pads, parts.soil, parts.cap, parts.stack, parts.frame, *links)
    walls = "the wall" if len(parts.walls) == 1 else "each wall"
    if len(parts.walls) > 1:
        others = " and ".join(filter(None, ["another RearWall", others]))
    if not others:
        if wall.si.on_body == 1:
            return []
        return [f"RearWall: there is no body {wall.si.on_body}; the wall stands behind one Block"]
    fault = f"a RearWall and {others} are both given; a wall stands behind a Block on rigid ground"
    if parts.frame is not None or parts.cap is not None:
        return [fault]
    yields = f"give {walls} a stiffness and a damping in place of its law"
    if parts.block is None:
        return [f"{fault}, unless it yields: {yields}"]
    elastic = equivalent_wall(wall, parts.block.si)
    why = (
        "its impacts are those of a block that nothing else holds"
        if base is None
        else f"{type(base).__name__} takes no impulse, and a body leans on a wall for a while"
    )
    return [
        f"{fault}, where base and wall are struck at once; {why}: {yields}. "
        f"stiffness='{elastic.stiffness:.4g} N/m', damping='{elastic.damping:.4g} N*s/m' throws it "
        f"back with {elastic.rebound:.3g} of its speed, within {1e3 * IMPACT_TIME:g} ms"
    ]


def _link_faults(parts: Parts) -> list[str]:
    """Return the faults of links with other parts."""
    faults: list[str] = []
    base = parts.pads or parts.soil
    if parts.cap is not None:
        kinds = " and a ".join(dict.fromkeys(type(part).__name__ for part in parts.links))
        faults.append(
            f"a {kinds} and a CushionCap are given together; give the cap as the lowest body of a "
            "Stack"
        )
    if parts.stack is None and parts.ground is not None:
        base = parts.ground
        if base.si.restitution is not None:
            faults.append(
                "RigidGround: beside restrainers impacts are plastic; restitution must not be given"
            )
    if isinstance(base, OwnBase):
        faults.append(
            "a body with a Restrainer stands on TwoSpringSupport, WinklerSoil or RigidGround, not "
            f"on {type(base).__name__}"
        )
    return faults


def _frame_faults(parts: Parts) -> list[str]:
    """Return the faults of columns under a beam with other parts."""
    faults = [
        "a Tendon of a RockingFrame goes along the axis of each column, bent below and above it: "
        f"{name} must not be given"
        for part in parts.links
        for name, usual in (("at", 0.0), ("depth", 0.0), ("on_body", 1))
        if isinstance(part, Tendon) and getattr(part.si, name) != usual
    ]
    others = _class_names(*(
        part
        for slot, part in parts.components.items()
        if slot not in ("frame", "ground") and not isinstance(part, Tendon)
    ))  # fmt: skip
    if others:
        faults.append(
            f"a RockingFrame and {others} are both given; a RockingFrame stands on rigid ground, "
            "with nothing else but tendons"
        )
    return faults


def _stack_faults(stack: Stack, parts: Parts) -> list[str]:
    """Return the faults of a stack with other parts."""
    faults: list[str] = []
    if parts.block is not None:
        name = type(parts.block).__name__
        faults.append(f"a Stack and a {name} are both given; the {name} is one of its bodies")
    if parts.cap is not None:
        faults.append("a Stack and a CushionCap are both given; give the cap as its lowest body")
    bases = [parts.components[slot] for slot in BASE_SLOTS if slot in parts.components]
    if parts.pads is not None and parts.soil is not None and parts.cap is None:
        faults.append("a Stack stands on a TwoSpringSupport or on a WinklerSoil: give one of them")
    standing = (*stack.interfaces, *bases)
    faults += [
        "the bodies of a Stack stand on TwoSpringSupport, WinklerSoil or RigidGround, not on "
        f"{type(part).__name__}"
        for part in standing
        if slot_of_class(type(part)) not in BASE_SLOTS or isinstance(part, OwnBase)
    ]
    if any(isinstance(part, RigidGround) and part.si.restitution is not None for part in standing):
        faults.append(
            "RigidGround: in a Stack impacts are plastic, and what they leave of the velocities of "
            "all bodies is computed; restitution must not be given"
        )
    return faults


def depth_cautions(parts: Parts) -> list[str]:
    """Warn of depths that differ, which can be simulated."""
    depths: dict[str, float] = {}  # depth with which each was made, where it is known
    for part in (parts.cap or parts.block, parts.soil):
        # without this a component without a depth would look for names like it
        known = getattr_static(part, "depth", None) is not None
        depth = getattr(part, "depth", None) if known else None
        if depth is not None:
            depths[type(part).__name__] = float(depth.m_as("m"))
    if len(depths) < 2 or math.isclose(*depths.values(), rel_tol=_DEPTH_TOLERANCE):
        return []
    (upper, above), (lower, below) = depths.items()
    return [
        f"the {lower} was built for a base of a depth of {below:.6g} m, but the {upper} on it is "
        f"{above:.6g} m deep: its stiffness is the subgrade modulus times that depth",
    ]


def _linked_bodies(parts: Parts) -> tuple[BlockSI, ...]:
    """Return the bodies to which links may be attached, from the top down; none of a frame."""
    if parts.stack is not None:
        return parts.stack.si.bodies
    return () if parts.block is None else (parts.block.si,)


def outside_point_cautions(parts: Parts) -> list[str]:
    """Warn of links at points that are above or below their bodies, or far beside them.

    A bracket or the arm of a statue may reach beyond the base, by no more than the body's height.
    """
    messages = list[str]()
    bodies = _linked_bodies(parts)
    for name, link in parts.named_links:
        points = list[tuple[int | None, tuple[float, float]]]()
        if isinstance(link, PointLink):
            points = [(link.si.on_body, link.si.on), (link.si.to_body, link.si.to)]
        elif isinstance(link, Load):
            points = [(link.si.on_body, link.si.at)]
        for number, (x, y) in points:
            if number is None or number > len(bodies):
                continue
            body = bodies[number - 1]
            reach, top = body.half_width + body.height, body.height * (1.0 + _ROUNDING)
            if abs(x) > reach or not body.height - top <= y <= top:
                messages.append(
                    f"{name}: its point ({x:.6g}, {y:.6g}) m is outside of body {number}, "
                    f"{body.width:.6g} m wide at its base and {body.height:.6g} m high; points "
                    "count from the middle of the base of their body"
                )
    return messages


def _tendon_and_wall_faults(parts: Parts) -> list[str]:
    """Return the faults of tendons and walls that miss their bodies."""
    faults = list[str]()
    bodies = _linked_bodies(parts)
    for name, link in parts.named_links:
        if not isinstance(link, Tendon | RearWall) or link.si.on_body > len(bodies):
            continue
        body = bodies[link.si.on_body - 1]
        if isinstance(link, Tendon):
            if abs(link.si.at) > body.half_width * _EDGE_TOLERANCE:
                faults.append(
                    f"{name}: a Tendon goes through its body, whose base ends "
                    f"{body.half_width:.6g} m beside its middle; at is {link.si.at:.6g} m"
                )
            below = bodies[link.si.on_body :]
            if below and link.si.depth > below[0].height * _EDGE_TOLERANCE:
                faults.append(
                    f"{name}: a Tendon through body {link.si.on_body} is held in the body below, "
                    f"which is {below[0].height:.6g} m high; depth is {link.si.depth:.6g} m"
                )
        elif link.si.height is not None and link.si.height > body.height * _EDGE_TOLERANCE:
            faults.append(
                f"{name}: its height is {link.si.height:.6g} m, above the top of body "
                f"{link.si.on_body} at {body.height:.6g} m"
            )
    return faults


def unused_option_cautions(parts: Parts, options: Options) -> list[str]:
    """Warn of options that have no effect in a scene of these parts."""
    between = () if parts.stack is None else parts.stack.interfaces
    bases = (*parts.structural(), *between)
    yielding = any(slot_of_class(type(part)) in ("pads", "soil") for part in bases)
    has_friction = any(getattr(part.si, "friction", None) is not None for part in bases)
    options_at_work = (  # name, default, whether the scene uses it, and why it does not
        ("coupling", Coupling.COUPLED, {"pads", "cap", "soil"} <= parts.signature,
         "it joins pads, a CushionCap and soil, and the scene does not have all of them"),
        ("restraint", Restraint.CONTACT_STATE, yielding or parts.own,
         "on rigid ground the bearing corner is held"),
        ("sliding", Sliding.COMPUTED, has_friction or parts.own,
         "no base has a friction that could be compared with what is needed"),
    )  # fmt: skip
    messages = [
        f"{name}={str(getattr(options, name))!r} changes nothing here: {why}"
        for name, default, used, why in options_at_work
        if getattr(options, name) is not default and not used
    ]
    for name, link in parts.named_links:
        if not isinstance(link, Restrainer | Tendon) or link.si.strength is not None:
            continue
        ends = getattr(link.si, "breaking_elongation", None) is not None
        if not ends and link.si.brittle != type(link).brittle.default:
            messages.append(
                f"{name}: brittle={link.si.brittle} changes nothing: it has no strength at which "
                "it could break or yield"
            )
    return messages


def _block_slides(parts: Parts, options: Options) -> bool:
    """Whether a block slides on what it stands on."""
    of_stages = parts.cap is not None and options.coupling is Coupling.CASCADE
    under = parts.pads or parts.soil or parts.ground
    slippery = under is not None and base_friction(under, options) is not None
    return slippery and parts.rigid_wall is None and not of_stages


def size_faults(parts: Parts, options: Options) -> list[str]:
    """Return the faults of the sizes of parts that are together."""
    block, cap = parts.block, parts.cap
    faults: list[str] = []
    # a squat body may land flat if it slides, or stands in a stack; soil stops it without impact
    on_soil = parts.soil is not None and parts.pads is None
    if block is not None and not (on_soil or parts.own or _block_slides(parts, options)):
        faults += squat_body_warnings(block.si, type(block).__name__)
    if parts.links:
        faults += _tendon_and_wall_faults(parts)
    if block is not None and cap is not None:
        body = parts.cap_si
        width = 2.0 * body.half_width
        if not isfinite(body.inertia + block.si.mass * body.half_height * body.half_height):
            faults.append(
                f"a CushionCap of {width:.12g} m by {cap.si.height:.12g} m under the building has "
                "a moment of inertia that a computer's numbers cannot hold"
            )
        if width < block.si.width * (1.0 - _ROUNDING):
            faults.append(
                f"the CushionCap is {width:.12g} m wide, narrower than the {block.si.width:.12g} m "
                "of the building on it"
            )
    if block is not None and {"pads", "soil"} & {*parts.components}:
        width = block.si.width if cap is None else 2.0 * parts.cap_si.half_width
        if not isfinite(width * width * width):  # of which rotational stiffnesses are made
            faults.append(
                f"a base {width:.12g} m wide has a rotational stiffness that a computer's numbers "
                "cannot hold"
            )
    return faults
