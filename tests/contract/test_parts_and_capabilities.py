"""Walls, frames, tendons, loads, ties and mixed bases support every function of the package."""

import json
from contextlib import nullcontext
from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from plain_python import plain_python

import rockframe as rf
from rockframe.command.files.scenes import read_scene
from rockframe.compiled import COMPILED

BLOCK = rf.Block(width="1 m", height="4 m", mass="4 t")
PADS = rf.TwoSpringSupport(frequency_ratio=10, damping_ratio=0.1)
BENT = rf.RockingFrame(BLOCK, columns=2, beam_mass="6 t")
PULSE = rf.GroundMotion.from_arrays(
    (3.5 * np.sin(np.linspace(0.0, 2.0 * np.pi, 41)), "m/s^2"), time_step="0.02 s", name="pulse"
)
PLAN = {"duration": "1.6 s"}

IN_FILE = {
    "block": '[block]\nwidth = "1 m"\nheight = "4 m"\nmass = "4 t"\n',
    "pads": "[pads]\nfrequency_ratio = 10\ndamping_ratio = 0.1\n",
    "slippery ground": "[ground]\nfriction = 0.2\n",
    "slippery pads": "[pads]\nfrequency_ratio = 10\ndamping_ratio = 0.1\nfriction = 0.2\n",
    "statue on a block": '[[stack.bodies]]\nwidth = "0.8 m"\nheight = "1.2 m"\nmass = "1 t"\n'
    '[[stack.bodies]]\nwidth = "1 m"\nheight = "4 m"\nmass = "4 t"\n'
    '[[stack.interfaces]]\ntype = "RigidGround"\nfriction = 0.2\n',
    "frame": '[frame]\ncolumns = 2\nbeam_mass = "6 t"\n'
    '[frame.column]\nwidth = "1 m"\nheight = "4 m"\nmass = "4 t"\n',
}
TIE = rf.Restrainer(
    on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="0.2 MN/m", slack="0.5 mm"
)
TIE_IN_FILE = (
    '[[restrainer]]\non = ["-0.5 m", "3 m"]\nto = ["-1.5 m", "3 m"]\n'
    'stiffness = "0.2 MN/m"\nslack = "0.5 mm"\n'
)
SCENES = {
    "stiff wall": (
        (BLOCK, rf.RearWall(restitution=-0.3)), "restitution", [-0.5, -0.1],
        ("block",), "[wall]\nrestitution = -0.3\n",
    ),
    "elastic wall": (
        (BLOCK, rf.RearWall(stiffness="1 MN/m", gap="5 mm")), "gap", ["0 mm", "5 mm"],
        ("block",), '[wall]\nstiffness = "1 MN/m"\ngap = "5 mm"\n',
    ),
    "elastic wall on pads": (
        (BLOCK, PADS, rf.RearWall(stiffness="1 MN/m")), "RearWall.stiffness", ["1 MN/m", "2 MN/m"],
        ("block", "pads"), '[wall]\nstiffness = "1 MN/m"\n',
    ),
    "pads between elastic walls": (
        (BLOCK, PADS, *(rf.RearWall(side=one, stiffness="1 MN/m") for one in ("left", "right"))),
        "wall_2.stiffness", ["1 MN/m", "2 MN/m"], ("block", "pads"),
        '[[wall]]\nstiffness = "1 MN/m"\n[[wall]]\nside = "right"\nstiffness = "1 MN/m"\n',
    ),
    "frame": ((BENT,), "beam_mass", ["0 t", "6 t"], ("frame",), ""),
    "frame with tendons": (
        (BENT, rf.Tendon(stiffness="0.2 MN/m", preload="5 kN")), "preload", ["5 kN", "9 kN"],
        ("frame",), '[[restrainer]]\ntype = "Tendon"\nstiffness = "0.2 MN/m"\npreload = "5 kN"\n',
    ),
    "tendon": (
        (BLOCK, rf.Tendon(stiffness="0.2 MN/m", preload="5 kN")), "preload", ["5 kN", "9 kN"],
        ("block",), '[[restrainer]]\ntype = "Tendon"\nstiffness = "0.2 MN/m"\npreload = "5 kN"\n',
    ),
    "load": (
        (BLOCK, rf.Load(at=("-0.4 m", "4 m"), vertical="3 kN")), "vertical", ["3 kN", "6 kN"],
        ("block",), '[[restrainer]]\ntype = "Load"\nat = ["-0.4 m", "4 m"]\nvertical = "3 kN"\n',
    ),
}  # fmt: skip
for one, base in (("ground", rf.RigidGround()), ("pads", PADS)):
    SCENES[f"tied on slippery {one}"] = (
        (BLOCK, base.replace(friction=0.2), TIE), "Restrainer.slack", ["0.1 mm", "0.5 mm"],
        ("block", f"slippery {one}"), TIE_IN_FILE,
    )  # fmt: skip
TIED = {"tied on slippery ground", "tied on slippery pads"}
MIXED = "rigid joint and pads that slip"
STATUE = rf.Block(width="0.8 m", height="1.2 m", mass="1 t")
JOINT = rf.RigidGround(friction=0.2)
SCENES[MIXED] = (
    (rf.Stack(STATUE, BLOCK, interfaces=[JOINT]), PADS.replace(friction=0.2)),
    "TwoSpringSupport.friction", [0.1, 0.2], ("statue on a block", "slippery pads"), "",
)  # fmt: skip
ON_CAP = "pads that slip on a cap"
CAP = rf.CushionCap(width="3 m", height="0.5 m", mass="2 t")
SCENES[ON_CAP] = (
    (BLOCK, CAP, rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2), PADS.replace(friction=0.2)),
    "TwoSpringSupport.friction", [0.1, 0.2], ("block", "slippery pads"),
    '[cap]\nwidth = "3 m"\nheight = "0.5 m"\nmass = "2 t"\n'
    '[soil]\nstiffness = "20 MPa"\ndamping_ratio = 0.2\n',
)  # fmt: skip
SLIPPERY = TIED | {MIXED, ON_CAP}
HAS_LINK = TIED | {
    "elastic wall", "elastic wall on pads", "pads between elastic walls", "frame with tendons",
    "tendon",
}  # fmt: skip


@pytest.fixture(autouse=True)
def _figures():
    yield
    plt.close("all")


@cache
def scene(name):
    return rf.System(*SCENES[name][0])


def plan(name):
    return {"duration": "0.6 s"} if name == MIXED else PLAN


@cache
def run_of(name):
    return scene(name).simulate(PULSE, **plan(name))


def describes(name, folder):
    text = scene(name).describe()
    assert "equations" in text
    assert type(SCENES[name][0][-1]).__name__ in text


def statics(name, folder):
    # of mixed bases, before a corner lifts from the rigid joint
    angles = [0.005, 0.01] if name == MIXED else [0.02, 0.05]
    found = scene(name).moment_rotation((np.array(angles), "rad"))
    assert np.isfinite(found.restoring_moment).all()
    scene(name).equilibrium()


def figures(name, folder):
    rf.plot.scene(scene(name))
    rf.plot.state(run_of(name))
    rf.plot.response(run_of(name))
    run_of(name).rockframe.player(folder / "run.html")


def ladder_and_tradeoff(name, folder):
    assert len(rf.model_ladder(scene(name))) >= 1
    table = rf.tradeoff(scene(name), PULSE, accuracies=["fast"], repeats=1, **plan(name))
    assert float(table.peak_error.max()) >= 0.0


def certificate(name, folder):
    run = scene(name).simulate(
        PULSE, certify=rf.Certification(runs=60), accuracy="fast", **plan(name)
    )
    assert "certificate" in " ".join(run.attrs)


def critical_scale(name, folder):
    found = rf.critical_scale(
        scene(name), PULSE, largest=4.0, scales=3, runs=3, accuracy="fast", progress=False,
        **plan(name),
    )  # fmt: skip
    assert "critical_scale" in found


def sweep_and_fragility(name, folder):
    _, axis, values, *_ = SCENES[name]
    runs = rf.sweep(
        scene(name), motions={"pulse": PULSE}, scale=[0.5, 1.0, 2.0], axes={axis: values},
        progress=False, **plan(name),
    )  # fmt: skip
    varied = next(dim for dim in runs.peak_rotation.dims if dim not in ("scale", "motion"))
    assert runs.peak_rotation.size == 6
    # one differs in its scene
    others = runs.isel(motion=0)
    assert any(
        (abs(one.diff(varied)) > 0).any()
        for one in others.data_vars.values()
        if varied in one.dims and one.dtype.kind in "fi"
    )
    first = runs.isel({varied: 0}, drop=True)
    assert rf.fragility(first, limits=[0.1]).sizes["limit_state"] == 2


def files(name, folder):
    system = scene(name)
    assert rf.System.from_dict(json.loads(json.dumps(system.to_dict()))) == system
    *_, slots, text = SCENES[name]
    # tables of one part must be contiguous
    (folder / "scene.toml").write_text("".join(IN_FILE[slot] for slot in slots) + text)
    assert read_scene(folder / "scene.toml").system == system
    run_of(name).to_netcdf(folder / "run.nc")
    with xr.open_dataset(folder / "run.nc") as read:
        again = rf.System.from_dataset(read)
        rotation = again.simulate(**plan(name)).rotation
        np.testing.assert_array_equal(rotation, read.rotation)


def report_and_table(name, folder):
    rf.report(run_of(name), folder / "report.html", certify=False)
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert type(SCENES[name][0][-1]).__name__ in page
    assert rf.table(run_of(name)).shape[1] > 5


def certified_report(name, folder):
    rf.report(run_of(name), folder / "report.html", certify=name != MIXED)
    assert "certificate" in (folder / "report.html").read_text(encoding="utf-8").lower()


def links(name, folder):
    assert ("restrainer" in run_of(name).dims) is (name in HAS_LINK)
    if name in HAS_LINK:
        assert float(run_of(name).peak_restrainer_force.max()) > 0.0
    slips = {"peak_slip", "peak_body_slip"} & set(run_of(name))
    assert bool(slips) is (name in SLIPPERY)
    assert all(float(run_of(name)[one].min()) > 0.0 for one in slips)


CAPABILITIES = (
    describes, statics, figures, ladder_and_tradeoff, certificate, critical_scale,
    sweep_and_fragility, files, report_and_table, certified_report, links,
)  # fmt: skip
SLOWEST = (ladder_and_tradeoff, certificate, certified_report)  # many steps or many runs
QUICK = ("stiff wall", "frame", "tendon")
"""Scenes of which even these take little."""


@pytest.mark.wide
@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(
    ("name", "capability"),
    [
        pytest.param(
            name, one, id=f"{name}-{one.__name__}",
            marks=[pytest.mark.long] if name not in QUICK and one in SLOWEST else [],
        )
        for name in SCENES for one in CAPABILITIES
    ],
)  # fmt: skip
def test_every_part_supports_every_capability(name, capability, tmp_path):
    many = capability in (certificate, critical_scale, certified_report)
    if many and not COMPILED and name not in ("stiff wall", "frame"):
        pytest.skip("many runs of scenes that are slow in plain Python")
    with (
        plain_python() if name == MIXED else nullcontext()
    ):  # its equations take the longest to compile
        capability(name, tmp_path)
