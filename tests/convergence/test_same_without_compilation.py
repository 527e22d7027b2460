"""Compiled and plain runs are the same source, and give the same numbers to the last bit."""

import os
import subprocess
import sys

import numpy as np
import pytest

RUN = """
import sys
import numpy as np
import rockframe as rf

rng = np.random.default_rng(3)
x, y = (np.convolve(rng.normal(size=201), np.ones(5) / 5, "same") for _ in range(2))
motion = rf.GroundMotion.from_arrays((8 * x, "m/s^2"), "0.02 s", vertical=(4 * y, "m/s^2"))
block = rf.Block.from_size(radius="3 m", slenderness=3, mass="2 t")
pads = rf.TwoSpringSupport(frequency_ratio=15, damping_ratio=0.1)
out = {}
for rule in ("contact-state", "leading-corner", "centre"):
    for rotation in ("finite", "small"):
        system = rf.System(block, pads, restraint=rule, rotation=rotation)
        out[f"{rule} {rotation}"] = system.simulate(motion, outputs=["energy"])
out["rigid"] = rf.System(block).simulate(motion, outputs=["energy"])
short = motion.window("0 s", "0.8 s")
light = rf.CushionCap(width="3 m", height="0.2 m", mass="0.4 t")
for rule, separation in (("contact-state", "displacement"), ("leading-corner", "pressure")):
    bed = rf.WinklerSoil(stiffness="3 MPa", damping_ratio=0.1, separation=separation)
    for coupling in ("coupled", "cascade"):
        system = rf.System(block, pads, light, bed, restraint=rule, coupling=coupling)
        out[f"{coupling} {rule}"] = system.simulate(short, outputs=["energy"])
cap = rf.CushionCap(height="0.5 m", mass="1 t")
soil = rf.WinklerSoil(stiffness="2 MPa", damping_ratio=0.2)
for name, parts, options in (
    ("rigid", (), {}),
    ("two-spring", (pads,), {"restraint": "leading-corner"}),
    ("soil", (soil,), {}),
    ("coupled", (pads, cap, soil), {}),
    ("cascade", (pads, cap, soil), {"coupling": "cascade"}),
):
    system = rf.System(block, *parts, **options)
    out[f"fast {name}"] = system.simulate(motion, accuracy="fast", outputs=["energy"])
arrays = {
    f"{scene}/{name}": variable.to_numpy()
    for scene, result in out.items()
    for name, variable in result.variables.items()
}
np.savez(sys.argv[1], **arrays)
"""


@pytest.mark.skipif(
    os.environ.get("ROCKFRAME_COMPILE") == "0", reason="this run does without compilation"
)
def test_compiled_and_plain_are_the_same(tmp_path):
    pytest.importorskip("numba")
    results = {}
    for compiled in ("wait", "0"):
        file = tmp_path / f"{compiled}.npz"
        subprocess.run(
            [sys.executable, "-c", RUN, str(file)],
            env=os.environ | {"ROCKFRAME_COMPILE": compiled},
            check=True,
        )
        results[compiled] = np.load(file)
    assert set(results["wait"].files) == set(results["0"].files)
    for name in results["wait"].files:
        np.testing.assert_array_equal(results["wait"][name], results["0"][name], err_msg=name)
    impacts = [results["wait"][name] for name in results["wait"].files if "impact_count" in name]
    assert max(int(count) for count in impacts) > 3
