"""Frames of each kind, by name."""

from rockframe.components import (
    FrameEquivalent,
    Member,
    RegularFrame,
)

SIZE = {"width": "4 m", "height": "9 m", "mass": "45.8 t"}
REGULAR = {
    "storeys": 3,
    "width": "4 m",
    "height": "9 m",
    "column_width": "0.25 m",
    "beam_height": "0.30 m",
    "beam_width": "0.25 m",
    "density": "2500 kg/m^3",
}


UNEQUAL = {key: value for key, value in REGULAR.items() if key not in ("storeys", "height")}
OUTLINE = {"width": "4 m", "height": "10 m"}
MIDDLE = {**OUTLINE, "centre_of_mass": "middle"}


def core(**changes):
    return Member(**{
        "name": "core", "kind": "wall", "mass": "10 t", "x": "0 m", "y": "5 m",
        "width": "2 m", "height": "10 m", "depth": "3 m", **changes,
    })  # fmt: skip


def tank(**changes):
    return Member(**{
        "name": "tank", "mass": "1 t", "x": "0.5 m", "y": "7 m", "inertia": "800 kg*m^2",
        **changes,
    })  # fmt: skip


def examples():
    return {
        "by shape factor": FrameEquivalent(**SIZE, shape_factor=1.153),
        "by inertia": FrameEquivalent(**SIZE, inertia="4e5 kg*m^2"),
        "regular": FrameEquivalent.from_members(**REGULAR),
        "regular without walls": FrameEquivalent.from_members(
            **{**REGULAR, "storeys": 6, "height": "18 m"}, infill_thickness=None
        ),
        "regular, all measures": FrameEquivalent.from_members(
            **UNEQUAL,
            storey_heights=["3.5 m", "300 cm", "2.9 m"],
            depth="6.1 m",
            column_depth="0.4 m",
            slab_thickness="0.2 m",
            infill_thickness="0.2 m",
        ),
        "members": FrameEquivalent.from_members([core(), tank()], **OUTLINE),
        "members, in the middle": FrameEquivalent.from_members([core(), tank()], **MIDDLE),
        "members with depth": FrameEquivalent.from_members([core()], **OUTLINE, depth="4 m"),
        "member": core(),
        "member by inertia": tank(),
        "member by density": core(mass=None, density="2.5 t/m^3"),
        "regular frame": RegularFrame(**REGULAR),
        "regular frame, unequal": RegularFrame(
            **UNEQUAL, storey_heights="3.5 m; 3 m", infill_thickness=None
        ),
    }


EXAMPLES = examples()
