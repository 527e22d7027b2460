"""A museum case on the ground, and on every floor of a six-storey building.

Usage: python examples/floor_motion.py [record] [--period 0.9] [--folder results]

The building is elastic, of equal storeys. Without a record the motion is drawn from a model of an
earthquake of magnitude 7.2 at 5 km. Prints what becomes of the case on each floor, and writes
floor_motion.nc (the motion of the fourth floor), floor_motion.png (that motion) and
case_on_floor_4.png (the case under it).
"""

import argparse
import sys
from pathlib import Path

import rockframe as rf

STOREYS = 6
SHOWN = 4


def advice(fallen: list[bool]) -> str:
    """Say where the case may stand; the first place is the ground."""
    if fallen[0]:
        return "The case falls even on the ground: fix it wherever it stands."
    floors = [str(floor) for floor, falls in enumerate(fallen) if falls]
    if not floors:
        return "The case stays up everywhere."
    named = " and ".join(filter(None, [", ".join(floors[:-1]), floors[-1]]))
    several = "floors" if len(floors) > 1 else "floor"
    return (
        f"On the ground the case stays up; on {several} {named} the same earthquake throws it "
        "down, because the building shakes harder there, and in its own rhythm."
    )


def main() -> int:
    """Read the arguments, run, and tell in one line why it cannot be done."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("record", nargs="?", help="ground-motion file; a synthetic one if none")
    parser.add_argument("--period", type=float, default=0.9, help="of the building [s]")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        shake_floors(arguments.record, arguments.period, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"floor_motion: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def shake_floors(record: str | None, period: float, folder: Path) -> None:
    """Let the same earthquake shake the case on every floor."""
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
    print(advice([bool(run.overturned.item()) for run in runs]))

    motions[SHOWN].to_dataset().to_netcdf(folder / "floor_motion.nc")
    rf.plot.motion(motions[SHOWN]).figure.savefig(folder / "floor_motion.png", dpi=150)
    shown = folder / f"case_on_floor_{SHOWN}.png"
    rf.plot.response(runs[SHOWN]).figure.savefig(shown, dpi=150)
    print(f"Motion of floor {SHOWN}: {folder / 'floor_motion.nc'}, figure of the case: {shown}")


if __name__ == "__main__":
    sys.exit(main())
