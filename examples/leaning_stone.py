"""A leaning stone: it overturns more easily to one side.

Usage: python examples/leaning_stone.py [--folder results]

A menhir, 0.9 m wide and 4.2 m high, on stiff soil; its top is 0.35 m off its foot. Prints
the peak acceleration of a pulse to either side that it withstands; writes leaning_stone.csv.
"""

import argparse
import math
from pathlib import Path

import rockframe as rf

LEAN = 0.35  # of the top [m]
PEAK = 3.0  # of the pulse [m/s^2]


def main() -> None:
    """Find the pulse that overturns the stone to either side."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the results are written")
    folder = Path(parser.parse_args().folder)
    outline = [(0.0, 0.0), (0.9, 0.0), (0.8 + LEAN, 4.2), (0.1 + LEAN, 4.2)]
    stone = rf.Block.from_outline(outline, unit="m", density="2650 kg/m^3", depth="0.7 m")
    soil = rf.WinklerSoil(stiffness="60 MPa", damping_ratio=0.1)
    system = rf.System(stone, soil)
    rest = system.equilibrium()
    print(f"On its soil the stone leans {math.degrees(rest.rest_rotation):.2f} degrees further.")
    pulse = rf.GroundMotion.sine_pulse(f"{PEAK} m/s^2", "0.8 Hz")
    runs, scales = [], {}
    for side, shaking in (("left", pulse.scaled(-1.0)), ("right", pulse)):
        found = rf.critical_scale(system, shaking, largest=4.0, scales=40, free_vibration="6 s")
        run = system.simulate(
            shaking.scaled(1.001 * found.critical_scale.item()), free_vibration="6 s"
        )
        runs.append(run)
        scales[side] = found.critical_scale.item()
        print(
            f"A pulse that starts to the {side} needs {PEAK * scales[side]:.2f} m/s^2; the stone "
            f"falls to the {run.attrs['overturning_direction']}."
        )
    rf.table(runs).to_csv(folder / "leaning_stone.csv")
    weaker, stronger = sorted(scales, key=lambda side: scales[side])
    reduction = 100.0 * (1.0 - scales[weaker] / scales[stronger])
    print(
        f"The stone is weaker to the side it leans to: a pulse that starts to the {weaker} "
        f"overturns it at an amplitude {reduction:.0f} % lower."
    )


if __name__ == "__main__":
    main()
