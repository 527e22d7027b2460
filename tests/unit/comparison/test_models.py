"""The ladder of models."""

import pytest

import rockframe as rf
from rockframe.errors import ModelWarning

BLOCK = rf.Block(width="4 m", height="18 m", mass="99 t")
PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
CAP = rf.CushionCap(height="0.9 m", mass="36 t")
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.20)
STACK = ("rigid ground", "two pads", "pads, cap and soil by cascade", "pads, cap and soil coupled")


def with_small(names):
    return [words for name in names for words in (f"{name}, small rotations", name)]


@pytest.mark.parametrize(
    ("parts", "options", "names"),
    [
        ((BLOCK,), {}, STACK[:1]),
        ((BLOCK, PADS), {}, STACK[:2]),
        ((BLOCK, PADS, CAP, SOIL), {}, STACK),
        ((BLOCK, PADS, CAP, SOIL), {"coupling": "cascade"}, STACK[:3]),
        ((BLOCK, SOIL), {}, ("rigid ground", "soil")),
        ((BLOCK, CAP, SOIL), {}, ("rigid ground", "soil", "cap and soil")),
        # too squat to rock on rigid ground
        ((BLOCK.replace(height="2 m"), SOIL), {}, ("soil",)),
    ],
)
def test_model_ladder_contains_the_simpler_models(parts, options, names):
    system = rf.System(*parts, **options)
    ladder = rf.model_ladder(system)
    assert list(ladder) == with_small(names)
    assert ladder[names[-1]].to_dict() == system.to_dict()


def test_small_rotations_stay_small():
    system = rf.System(BLOCK, PADS, rotation="small")
    ladder = rf.model_ladder(system)
    assert list(ladder) == ["rigid ground, small rotations", "two pads, small rotations"]
    assert list(ladder.values())[-1].to_dict() == system.to_dict()


def test_ladder_preserves_options_and_ground():
    ground = rf.RigidGround(restitution=0.8)
    system = rf.System(BLOCK, ground, restraint="leading-corner", gravity="3.7 m/s^2")
    for rung in rf.model_ladder(system).values():
        assert rung.parts.ground == ground
        assert str(rung.restraint) == "leading-corner"
        assert rung.options.gravity == 3.7


def test_ladder_does_not_repeat_warnings_of_the_scene():
    with pytest.warns(ModelWarning, match="restitution"):
        system = rf.System(BLOCK, rf.RigidGround(restitution=1.0))
    assert len(rf.model_ladder(system)) == 2


TIE = rf.Restrainer(on=("-0.5 m", "3 m"), to=("-2 m", "3 m"), stiffness="1 MN/m", slack="5 mm")
UPON = rf.Stack(BLOCK, BLOCK, interfaces=[PADS])
BENT = rf.RockingFrame(BLOCK, columns=2, beam_mass="1 t")
LOAD = rf.Load(at=("0 m", "4 m"), vertical="5 kN")


@pytest.mark.parametrize(
    ("parts", "bases", "acts"),
    [
        ((BLOCK, PADS, TIE, LOAD), ("rigid ground", "two pads"), "restrainers and loads"),
        ((UPON, TIE), ("stack on rigid ground",), "restrainers"),
        ((BENT, rf.Tendon(stiffness="1 MN/m")), ("rigid ground",), "tendons"),
    ],
)
def test_ladder_has_rungs_without_and_with_restrainers_and_loads(parts, bases, acts):
    system = rf.System(*parts)
    ladder = rf.model_ladder(system)
    rungs = [(f"{base}, small rotations", base, f"{base} with {acts}") for base in bases]
    assert list(ladder) == [name for names in rungs for name in names]
    assert list(ladder.values())[-1].to_dict() == system.to_dict()


def test_ladder_of_a_tied_block_ends_with_sliding():
    ladder = rf.model_ladder(rf.System(BLOCK, rf.RigidGround(friction=0.2), TIE))
    assert list(ladder)[-2:] == [
        "rigid ground with restrainers", "rigid ground with restrainers, sliding",
    ]  # fmt: skip


def test_a_squat_body_has_only_the_rung_that_slides_named_by_its_base():
    low, tie = rf.Block(width="4 m", height="2 m", mass="20 t"), TIE.replace(on=("-1 m", "1 m"))
    pads = PADS.replace(friction=0.3)
    for parts, name in (
        ((rf.RigidGround(friction=0.3),), "rigid ground, sliding"),
        ((pads, tie), "two pads with restrainers, sliding"),
        ((pads, CAP, SOIL), "pads, cap and soil coupled, sliding"),
    ):
        system = rf.System(low, *parts)
        assert {name: system.to_dict()} == {
            name: rung.to_dict() for name, rung in rf.model_ladder(system).items()
        }


@pytest.mark.parametrize("options", [{}, {"rotation": "small"}])
def test_ladder_without_the_wall_does_not_slide(options):
    """Without the wall, the ground has friction and the block slides."""
    wall, ground = rf.RearWall(side="left"), rf.RigidGround(friction=0.3)
    ladder = rf.model_ladder(rf.System(BLOCK, ground, wall, **options))
    assert list(ladder)[-1].startswith("rigid ground and wall")
    assert not any(model.setting.slides for model in ladder.values())
