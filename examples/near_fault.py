"""Whether the pulse of a near-fault motion overturns a block, or the rest of the motion.

Usage: python examples/near_fault.py [record] [--component N] [--folder results]

Without a record the pulse of a rupture that runs towards the site is added to a motion that was
recorded far from the fault and comes with rockframe. Finds the pulse, runs a block under the whole
motion, under the pulse alone and under the residual motion, and prints which of them overturn it.
Writes near_fault.png (velocities of the motion, the pulse and the rest).
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import rockframe as rf


def motion_with_pulse() -> rf.GroundMotion:
    """Add a pulse of 1.2 s and 0.6 m/s to the record of Loma Prieta, scaled to 0.15 g."""
    record = rf.GroundMotion.example("loma-prieta").scaled(peak="0.15 g_0")
    pulse = rf.GroundMotion.mavroeidis_papageorgiou_pulse("60 cm/s", "0.8 Hz", 2, "0 deg")
    samples = record.si.horizontal.samples
    time = np.arange(samples.size) * record.si.time_step
    combined = samples + pulse.si.at(time - 8.0)
    step = f"{record.si.time_step!r} s"
    return rf.GroundMotion.from_arrays((combined, "m/s^2"), step, name="Loma Prieta and a pulse")


def main() -> int:
    """Read the arguments and run; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; synthetic if none")
    parser.add_argument("--component", help="component of the record, such as N or 090")
    parser.add_argument("--folder", default=".", help="where the figure is written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        motion = motion_with_pulse()
        if arguments.record:
            motion = rf.GroundMotion.read(arguments.record, component=arguments.component)
        simulate_parts(motion, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"near_fault: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def simulate_parts(motion: rf.GroundMotion, folder: Path) -> None:
    """Find the pulse, and simulate the block under each part of the motion."""
    pulse = motion.velocity_pulse()
    print(f"{motion.name}: {pulse}")

    block = rf.System(rf.Block(width="0.45 m", height="2.5 m", mass="1.5 t"))
    parts = {"whole motion": motion, "pulse alone": pulse.extracted, "the rest": pulse.residual}
    for name, part in parts.items():
        response = block.simulate(part, free_vibration="5 s", outputs=None)
        peak = part.peak_acceleration.m_as("g_0")
        print(f"  {name:12} {peak:.2f} g: {response.attrs['verdict']}")

    above, _ = rf.plot.velocity_pulse(pulse)
    above.figure.savefig(folder / "near_fault.png", dpi=150)
    print(f"Figure: {folder / 'near_fault.png'}")


if __name__ == "__main__":
    sys.exit(main())
