"""The page "Systems" describes options, arguments and scenes correctly."""

import inspect
import re
import warnings

import pytest
from pages import numbers_in, read, table

import rockframe as rf
from rockframe.errors import ModelWarning

PAGE = "guide/systems.md"
BLOCK = rf.Block(width="4.85 m", height="19.4 m", mass="600 t")
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.10)
BUILDING = rf.FrameEquivalent(width="4 m", height="18 m", mass="99 t", shape_factor=2.923)
STIFF_PADS = rf.TwoSpringSupport(frequency_ratio=40, damping_ratio=0.10)
CAP = rf.CushionCap(height="0.9 m", mass="36 t")
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20)
PRESSED = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.20, separation="pressure")

OPTIONS = {
    "contact-state": rf.System(BLOCK, PADS),
    "leading-corner": rf.System(BLOCK, PADS, restraint="leading-corner"),
    "centre": rf.System(BLOCK, PADS, restraint="centre"),
    "small rotation": rf.System(BLOCK, PADS, rotation="small"),
    "rigid ground": rf.System(BLOCK),
}
STACK = (BUILDING, STIFF_PADS, CAP, SOIL)
SCENES = {
    "building on rigid ground": rf.System(BUILDING),
    "pads": rf.System(BUILDING, STIFF_PADS),
    "soil": rf.System(BUILDING, SOIL),
    'soil, `separation="pressure"`': rf.System(BUILDING, PRESSED),
    "cap, soil": rf.System(BUILDING, CAP, SOIL),
    "pads, cap, soil": rf.System(*STACK),
    'the same, `separation="pressure"`': rf.System(BUILDING, STIFF_PADS, CAP, PRESSED),
    'the same, `rotation="small"`': rf.System(*STACK, rotation="small"),
    'the same, `coupling="cascade"`': rf.System(
        BUILDING, STIFF_PADS, CAP, SOIL, coupling="cascade"
    ),
}


def test_documented_peaks_and_impacts_are_reproduced():
    options = {name: cells for name, *cells in table(PAGE, "| | peak | impacts |")}
    assert list(options) == list(OPTIONS)
    for name, (peak, impacts) in options.items():
        run = OPTIONS[name].simulate(
            rf.GroundMotion.sine_pulse(), free_vibration="5 s", accuracy="reference", outputs=None
        )
        assert f"{float(run.peak_relative_rotation):.6f}" == peak
        assert int(run.impact_count) == int(impacts)
    scenes = {name: cells for name, *cells in table(PAGE, "| parts | peak | impacts |")}
    assert list(scenes) == list(SCENES)
    for name, (peak, impacts) in scenes.items():
        motion = rf.GroundMotion.sine_pulse("-3 m/s^2")
        run = SCENES[name].simulate(motion, free_vibration="5 s", outputs=None)
        assert f"{float(run.peak_rotation):.5f}" == peak
        assert int(run.impact_count) == int(impacts)


def test_documented_arguments_and_defaults_of_simulate_match():
    rows = table(PAGE, "| argument | default | meaning | explained in |")
    arguments = dict(inspect.signature(rf.System.simulate).parameters)
    del arguments["self"]
    assert [row[0].strip("`") for row in rows] == list(arguments)
    for (_, documented_default, *_), argument in zip(rows, arguments.values(), strict=True):
        if argument.default is None:
            assert "`" not in documented_default  # in words: the meaning of None
        else:
            default = argument.default
            shown = f'"{default}"' if isinstance(default, str) else repr(default)
            assert documented_default == f"`{shown}`"


def test_every_argument_is_explained_on_linked_page():
    for name, _, _, where in table(PAGE, "| argument | default | meaning | explained in |"):
        pages = re.findall(r"\{doc\}`(\w+)`", where)
        texts = [read(f"guide/{page}.md") for page in pages] or [read(PAGE)]
        word = "GroundMotion" if name == "`motion`" else name.strip("`")
        assert any(word in text for text in texts), f"{name} is not on {pages}"


def test_documented_energies_are_reproduced():
    """Numbers of "Energy" and of "Impact and restraint", for the same block and pads."""
    words = "of 4.85 m by 19.4 m and 600 t on pads of"
    assert words in " ".join(read("theory/energy.md").split())
    separations, landings, leading, centre = numbers_in(
        "theory/energy.md",
        "# separations and # landings, and a drift of # (`leading-corner`) and # (`centre`)",
    )
    dissipated, most = numbers_in(
        "theory/energy.md", "re-pinnings dissipate # J of # MJ in the same run"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # a restitution of one
        elastic = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0, restitution=1)
        runs = {
            restraint: rf.System(BLOCK, elastic, restraint=restraint).simulate(
                duration="20 s",
                initial=rf.InitialState(rotation="0.1 rad"),
                accuracy="reference",
                outputs="energy",
            )
            for restraint in ("leading-corner", "centre", "contact-state")
        }
    for restraint, drift in (("leading-corner", leading), ("centre", centre)):
        run = runs[restraint]
        energy = run.kinetic_energy + run.potential_energy + run.elastic_energy
        off = float(abs(energy - energy[0]).max() / run.kinetic_energy.max())
        assert off == pytest.approx(drift, rel=0.5)
        kinds = run.event_kind.values.tolist()
        assert (kinds.count(1), kinds.count(2)) == (separations, landings)
    run = runs["contact-state"]
    assert float(run.repinning_energy[-1]) == pytest.approx(dissipated, rel=0.01)
    assert float(run.kinetic_energy.max()) == pytest.approx(1e6 * most, rel=0.01)

    lost, put_in = numbers_in(
        "theory/impact_and_restraint.md", "loses # J by re-pinning, of # MJ supplied by the ground"
    )
    shaken = OPTIONS["contact-state"].simulate(
        rf.GroundMotion.sine_pulse(), free_vibration="5 s", outputs="energy", accuracy="reference"
    )
    assert float(shaken.repinning_energy[-1]) == pytest.approx(lost, rel=0.01)
    assert float(shaken.input_energy.max()) == pytest.approx(1e6 * put_in, rel=0.01)
