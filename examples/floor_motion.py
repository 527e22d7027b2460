"""A museum case on the ground, and on every floor of a six-storey building.

Usage: python examples/floor_motion.py [record] [--period 0.9] [--folder results]

The building is elastic, of equal storeys. Without a record the motion is a sample of a stochastic
model of an earthquake of magnitude 7.2 at 5 km. Prints the verdict on each floor, and writes
floor_motion.nc (the motion of the fourth floor), floor_motion.png (that motion) and
case_on_floor_4.png (the case under it).
"""

import argparse
import sys
from pathlib import Path

import rockframe as rf

STOREYS = 6
PLOTTED_FLOOR = 4


def safe_places(overturned: list[bool]) -> str:
    """Summarise on which floors the case overturns; the first entry is the ground."""
    if overturned[0]:
        return "The case overturns even on the ground: anchor it wherever it stands."
    floors = [str(floor) for floor, falls in enumerate(overturned) if falls]
    if not floors:
        return "The case stays up everywhere."
    listed = " and ".join(filter(None, [", ".join(floors[:-1]), floors[-1]]))
    several = "floors" if len(floors) > 1 else "floor"
    return (
        f"On the ground the case stays up; on {several} {listed} the same earthquake "
        "overturns it, because the building amplifies the motion, most of all near its own periods."
    )


def main() -> int:
    """Read the arguments and run; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; a synthetic one if none")
    parser.add_argument("--period", type=float, default=0.9, help="of the building [s]")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        simulate_floors(arguments.record, arguments.period, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"floor_motion: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def simulate_floors(record: str | None, period: float, folder: Path) -> None:
    """Simulate the case on the ground and on every floor under the same earthquake."""
    if record:
        ground = rf.GroundMotion.read(record)
    else:
        ground = rf.GroundMotion.stochastic(7.2, "5 km", seed=3)
    case = rf.System(rf.Block(width="0.45 m", height="1.8 m", mass="250 kg"))

    print(f"A case 1.8 m high and 0.45 m deep, shaken by {ground.name}:")
    motions = [ground]
    motions += [
        ground.through_storeys(storeys=STOREYS, floor=floor, period=f"{period!r} s")
        for floor in range(1, STOREYS + 1)
    ]
    runs = [case.simulate(motion, free_vibration="5 s") for motion in motions]
    for floor, (motion, run) in enumerate(zip(motions, runs, strict=True)):
        place = f"on floor {floor}" if floor else "on the ground"
        peak = motion.peak_acceleration.m_as("g_0")
        print(f"  {place:13}  {peak:.2f} g  {run.attrs['verdict']}")
    print(safe_places([bool(run.overturned.item()) for run in runs]))

    motions[PLOTTED_FLOOR].to_dataset().to_netcdf(folder / "floor_motion.nc")
    rf.plot.motion(motions[PLOTTED_FLOOR]).figure.savefig(folder / "floor_motion.png", dpi=150)
    figure_path = folder / f"case_on_floor_{PLOTTED_FLOOR}.png"
    rf.plot.response(runs[PLOTTED_FLOOR]).figure.savefig(figure_path, dpi=150)
    print(f"Motion of floor {PLOTTED_FLOOR}: {folder / 'floor_motion.nc'}, case: {figure_path}")


if __name__ == "__main__":
    sys.exit(main())
