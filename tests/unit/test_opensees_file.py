"""The exported OpenSees file: its numbers, and its results where openseespy is installed."""

import csv
import importlib.util
import re
import runpy
import subprocess
import sys

import numpy as np
import pytest
from pages import table

import rockframe as rf
from rockframe.errors import ComponentError, FileError

BLOCK = rf.Block(width="0.8 m", height="3.6 m", mass="2 t", shape_factor=2.5)
PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.2)
PULSE = rf.GroundMotion.sine_pulse("1.6 m/s^2", "1 Hz")
BASES = {"pads": PADS, "soil": SOIL, "rigid ground": rf.RigidGround()}
PAGE = "recipes/opensees.md"
HEAD = (
    "| base | dashpots | peak, pulse [%] | peak, record [%] | history, pulse [%] | "
    "history, record [%] |"
)


class Recorder:
    """Records the calls of a model in the place of OpenSees."""

    def __init__(self):
        self.calls = []

    def __getattr__(self, name):
        return lambda *args: self.calls.append((name, *args))

    def of(self, name):
        return [call[1:] for call in self.calls if call[0] == name]


def written(system, motion, tmp_path, **options):
    path = system.to_opensees(motion, tmp_path / "model.py", **options)
    return runpy.run_path(str(path))  # OpenSees is only imported by running the model


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("dashpots", ["let go", "attached"])
def test_opensees_model_matches_the_system(base, dashpots, tmp_path):
    system = rf.System(BLOCK, BASES[base], restraint="centre")
    both = PULSE.with_vertical(PULSE.scaled(0.5))
    found = written(system, both, tmp_path, free_vibration="1 s", springs=10, dashpots=dashpots)
    parameters, ops = found["PARAMETERS"], Recorder()
    middle, above, top = found["build"](ops, parameters)
    places = {tag: np.array(place) for tag, *place in ops.of("node")}
    masses = {tag: mass for tag, mass, _ in ops.of("mass")}
    assert min(masses.values()) > 0.0
    total = sum(masses.values())
    centre = sum(mass * places[tag] for tag, mass in masses.items()) / total
    inertia = sum(mass * np.sum((places[tag] - centre) ** 2) for tag, mass in masses.items())
    assert total == pytest.approx(2000.0, rel=1e-12)
    np.testing.assert_allclose(centre, [0.0, 1.8], atol=1e-12)
    expected = system.setting.body.inertia
    assert inertia == pytest.approx(expected, rel=1e-12)
    assert top == places[above][1] - places[middle][1]
    springs = [call for call in ops.of("element") if call[0] == "zeroLength"]
    assert len(springs) == (10 if base == "soil" else 2)
    materials = {call[1]: call for call in ops.of("uniaxialMaterial")}
    kind, _, stiffness, *rest = materials[2]
    assert kind == ("ViscoelasticGap" if dashpots == "let go" else "ENT")
    damping = rest[0] if dashpots == "let go" else materials[4][2]
    vertical = stiffness * len(springs), damping * len(springs)
    if base == "soil":
        # each spring is in the middle of its part of the bed
        ends = np.linspace(-0.4, 0.4, 11)
        np.testing.assert_allclose(parameters["springs_at"], 0.5 * (ends[1:] + ends[:-1]))
        np.testing.assert_allclose(vertical, [0.8 * 9e6, 0.8 * system.setting.support.damping])
    elif base == "pads":
        setting = system.setting.support
        np.testing.assert_allclose(vertical, [2.0 * setting.stiffness, 2.0 * setting.damping])
    else:  # 400 times the frequency parameter p, with 0.7 of critical damping
        moment = 2000.0 * system.setting.gravity * np.hypot(0.4, 1.8)
        bounce = 400.0 * np.sqrt(moment / (expected + 2000.0 * (0.4**2 + 1.8**2)))
        np.testing.assert_allclose(vertical, [2000.0 * bounce**2, 2.0 * 0.7 * 2000.0 * bounce])
    # the fewest steps, but two at least, that give each bounce its number of steps
    steps = 0.01 / (2.0 * np.pi / np.sqrt(vertical[0] / 2000.0))
    steps *= 20 if base == "rigid ground" else 80
    assert parameters["steps_per_output"] == max(2, np.ceil(steps))
    weight = 2000.0 * system.setting.gravity
    sunk = next(call[-1] for call in materials.values() if call[0] == "InitStrainMaterial")
    assert -sunk * vertical[0] == pytest.approx(weight, rel=1e-12)
    assert sum(call[2] for call in ops.of("load")) == pytest.approx(-weight, rel=1e-12)
    across, up = (call[5:-1] for call in ops.of("timeSeries") if call[0] == "Path")
    np.testing.assert_array_equal(across, both.si.horizontal.samples)
    np.testing.assert_array_equal(up, both.si.vertical.samples)
    run = system.simulate(both, free_vibration="1 s", output_step="0.01 s")
    np.testing.assert_allclose(parameters["rotation"], run.rotation, rtol=1e-8, atol=1e-30)
    assert parameters["peak"] == run.peak_rotation.item()
    # every node has at least two bars, or is the middle of the base
    ends = [end for call in ops.of("element") if call[0] == "corotTruss" for end in call[2:4]]
    ground = {call[2] for call in springs}
    assert all(ends.count(tag) >= 2 for tag in places if tag not in ground)


@pytest.mark.parametrize(
    ("parts", "found"),
    [
        ([PADS, rf.CushionCap(height="0.5 m", mass="1 t"), SOIL], "found a CushionCap"),
        ([rf.RigidGround(friction=0.3)], "a base that slides"),
        ([rf.RearWall(side="left", restitution=-0.3)], "a RearWall"),
    ],
)
def test_scenes_without_opensees_counterpart_are_refused(parts, found, tmp_path):
    with pytest.raises(ComponentError, match=rf"to_opensees: expected a block on pads.*{found}"):
        rf.System(BLOCK, *parts).to_opensees(PULSE, tmp_path / "model.py")
    assert not list(tmp_path.iterdir())


def test_invalid_export_arguments_are_refused(tmp_path):
    system, path = rf.System(BLOCK, PADS), tmp_path / "model.py"
    bent = rf.Block(width="0.8 m", height="4 m", mass="2 t", centre_of_mass=("2 m", "0.1 m"))
    with pytest.raises(ComponentError, match="off the middle"):
        rf.System(bent, PADS).to_opensees(PULSE, path)
    with pytest.raises(ComponentError, match="needs a GroundMotion, got 3"):
        system.to_opensees(3, path)
    with pytest.raises(ComponentError, match="needs a System, got 3"):
        rf.export.to_opensees(3, PULSE, path)
    with pytest.raises(ComponentError, match="springs must be a whole number, 2 or more"):
        system.to_opensees(PULSE, path, springs=1)
    with pytest.raises(ComponentError, match="dashpots must be 'let go' or 'attached'"):
        system.to_opensees(PULSE, path, dashpots="none")
    with pytest.raises(FileError, match=r"\.py"):
        system.to_opensees(PULSE, tmp_path / "model.tcl")
    path.write_text("x = 1\n")
    with pytest.raises(FileError):
        system.to_opensees(PULSE, path)
    path.unlink()
    system.to_opensees(PULSE, path)
    system.to_opensees(PULSE.scaled(0.5), path)  # replaces its own file


def test_rotation_at_the_final_unaligned_time_is_not_exported(tmp_path):
    """A run that overturns ends between two samples; OpenSees continues to the next."""
    system = rf.System(BLOCK, PADS, restraint="centre")
    strong = PULSE.scaled(3.0)
    parameters = written(system, strong, tmp_path, free_vibration="3 s")["PARAMETERS"]
    run = system.simulate(strong, free_vibration="3 s", output_step="0.01 s", outputs=())
    assert run.overturned
    assert parameters["outputs"] == run.sizes["time"]
    assert parameters["rotation"].size == run.sizes["time"] - 1
    np.testing.assert_allclose(parameters["rotation"], run.rotation[:-1], rtol=1e-8, atol=1e-30)


def differences(system, motion, tmp_path, **options):
    """Run the file; return the differences of peak and history [%]."""
    path = system.to_opensees(motion, tmp_path / "model.py", **options)
    ran = subprocess.run(
        [sys.executable, str(path)], capture_output=True, text=True, check=False, timeout=300
    )
    assert ran.returncode == 0, ran.stderr
    with path.with_suffix(".csv").open() as file:
        head, *rows = csv.reader(file)
    assert head[0] == "time [s]"
    both = np.array(rows, float)
    peak, history = (float(one) for one in re.findall(r"differ by (\S+) %", ran.stdout))
    apart = np.abs(both[:, 1] - both[:, 2]).max() / np.abs(both[:, 2]).max()
    assert history == pytest.approx(100.0 * apart, rel=0.05)
    return peak, history


@pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)
@pytest.mark.parametrize("row", table(PAGE, HEAD), ids=lambda row: f"{row[0]}, {row[1]}")
@pytest.mark.filterwarnings("ignore:restitution 1 exceeds")
def test_opensees_reproduces_documented_differences(row, tmp_path):
    """Under the pulse; the record would take a minute."""
    block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    name, dashpots, peak, _, history, _ = row
    base = {"pads": PADS, "soil": SOIL, "rigi": rf.RigidGround()}[name[:4]]
    if "restitution 1" in name:
        base = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.0, restitution=1.0)
    motion = PULSE.scaled(1.6) if name.startswith("rigid") else PULSE
    options = {} if dashpots != "attached" else {"dashpots": dashpots}
    system = rf.System(block, base, restraint="centre")
    found = differences(system, motion, tmp_path, free_vibration="6 s", **options)
    np.testing.assert_allclose(found, (float(peak), float(history)), rtol=0.1, atol=5e-4)
