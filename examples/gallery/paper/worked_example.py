"""What the scripts of the paper's worked example share: its frames, and the record TCU128.

Section 4.3: two frames of Table 2 on pads, a cap and soil. The paper gives no width and no mass of
the cap: here it is as wide and as deep as the plan, 4 m, and of concrete.
"""

import os
import warnings
from pathlib import Path
from typing import Literal, TypeAlias

import rockframe as rf

STOREYS = (3, 6)
FREQUENCY_RATIOS = (20, 40, 60)
SOILS = (3, 6, 9, 12)  # k0 [MPa]
MASSES = {3: "45.8 t", 6: "99 t"}
PRINTED = {3: 1.153, 6: 0.380}
BY_MEMBERS = {3: 2.774, 6: 2.923}
COLOURS = {20: "#cc6677", 40: "#1f3a5f", 60: "#44aa99"}
RECORD = "PEERSMD_CHICHI_TCU128-N.AT2"

Coupling: TypeAlias = Literal["coupled", "cascade"]


def frame(storeys: int, shape_factors: dict[int, float] = PRINTED) -> rf.FrameEquivalent:
    """Return a frame of Table 2; the printed shape factor of six storeys brings a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rf.errors.ModelWarning)
        return rf.FrameEquivalent(
            width="4 m",
            height=f"{3 * storeys} m",
            mass=MASSES[storeys],
            shape_factor=shape_factors[storeys],
        )


def scene(
    storeys: int,
    frequency_ratio: float,
    coupling: Coupling = "coupled",
    *,
    soil: float = 9,
    shape_factors: dict[int, float] = PRINTED,
) -> rf.System:
    """Put a frame on pads, a cap and soil of some MPa."""
    return rf.System(
        frame(storeys, shape_factors),
        rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.10),
        rf.CushionCap(height=f"{0.15 * storeys} m", density="2500 kg/m^3", depth="4 m"),
        rf.WinklerSoil(stiffness=f"{soil} MPa", damping_ratio=0.20),
        coupling=coupling,
        gravity="9.81 m/s^2",
    )


def tcu128() -> rf.GroundMotion:
    """Read the record from 30 to 60 s, or draw a motion of its peak where it is not there."""
    beside = Path(rf.__file__).resolve().parents[2] / "shared" / "records"
    path = Path(os.environ.get("ROCKFRAME_RECORDS", beside)) / RECORD
    if path.is_file():
        return rf.GroundMotion.read(path).window("30 s", "60 s")
    print(f"{RECORD} is not in {path.parent} (set ROCKFRAME_RECORDS).")
    print("In its place: a synthetic motion of the same peak. The numbers are not those of TCU128.")
    return (
        rf.GroundMotion.stochastic(7.6, "20 km", seed=128)
        .window("0 s", "60 s")
        .scaled(peak="0.17 g_0")
    )
