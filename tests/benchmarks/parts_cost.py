"""Cost of each part: a run with it compared with the same run without it.

Run from the root, with ``PYTHONPATH=.`` and ``ROCKFRAME_COMPILE=wait``:
``python tests/benchmarks/parts_cost.py``, and with words in the names of parts to measure these
only. Writes docs/data/parts_cost.json. Runs with and without a part alternate, so that other work
on the machine affects both alike; a ratio is that of the least processor times.
"""

import json
import sys
import time
import warnings
from pathlib import Path

import numpy as np

import rockframe as rf

DATA = Path(__file__).resolve().parents[2] / "docs" / "data" / "parts_cost.json"
ROUNDS = 12
LEVELS = ("fast", "standard")
STEP, SAMPLES = 0.005, 12_000


def motion(peak):
    """Return a minute of noise in samples of 5 ms."""
    noise = np.convolve(np.random.default_rng(1).normal(size=SAMPLES), np.hanning(61), "same")
    return rf.GroundMotion.from_arrays(
        (peak * noise / abs(noise).max(), "m/s^2"), time_step=f"{STEP} s"
    )


def block(height=4.0):
    return rf.Block(width="1 m", height=f"{height} m", mass=f"{0.5 * height} t")


def pads(**friction):
    return rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1, **friction)


def stack(count, joint):
    """Return a stack of the height of one block."""
    return rf.Stack(*[block(high(count) / count)] * count, interfaces=[joint] * (count - 1))


def high(count):
    return max(4.0, count)


def tie(slack):
    return rf.Restrainer(
        on=("-0.5 m", "3 m"), to=("-1.5 m", "3 m"), stiffness="1 MN/m", slack=slack
    )


def frame():
    return rf.RockingFrame(block(), columns=3, beam_mass="1 t")


def scenes():
    """Return by name of the part: scenes without and with it, and the motion's peak."""
    rigid, soft = rf.System(block()), rf.System(block(), pads())
    wall = rf.RearWall(side="left", restitution=-0.5)
    elastic = rf.RearWall(side="left", stiffness="5 MN/m", damping="10 kN s/m", gap="5 mm")
    return {
        "friction that holds, rigid ground": (
            rigid, rf.System(block(), rf.RigidGround(friction=5.0, kinetic_friction=0.5)), 2.9,
        ),
        "friction that slips, rigid ground": (
            rigid, rf.System(block(), rf.RigidGround(friction=0.2)), 2.9,
        ),
        "friction that holds, pads": (soft, rf.System(block(), pads(friction=5.0)), 2.9),
        "friction that slips, pads": (soft, rf.System(block(), pads(friction=0.23)), 2.9),
        "stiff wall, rigid ground": (rigid, rf.System(block(), wall), 2.9),
        "elastic wall, pads": (soft, rf.System(block(), pads(), elastic), 2.9),
        "restrainer, slack, rigid ground": (rigid, rf.System(block(), tie("1 m")), 2.9),
        "restrainer, taut, rigid ground": (rigid, rf.System(block(), tie("1 mm")), 2.9),
        "restrainer, slack, pads": (soft, rf.System(block(), pads(), tie("1 m")), 2.9),
        "restrainer, taut, pads": (soft, rf.System(block(), pads(), tie("1 mm")), 2.9),
        "frame of three columns": (rigid, rf.System(frame()), 2.9),
        "tendon in the frame": (
            rf.System(frame()),
            rf.System(frame(), rf.Tendon(stiffness="1 MN/m", preload="1 kN")), 2.9,
        ),
        **{
            f"stack of {count}, {name}": (
                rf.System(block(high(count)), *base), rf.System(stack(count, joint), joint),
                peak / high(count),
            )
            for name, joint, base, peak in (
                ("rigid joints", rf.RigidGround(), (), 10.4), ("pads", pads(), (pads(),), 7.0),
            )
            for count in (2, 4, 8)
        },
        **{
            f"stack of {count}, friction that {name}, rigid joints": (
                rf.System(stack(count, rf.RigidGround()), rf.RigidGround()),
                rf.System(stack(count, joint), joint), peak / high(count),
            )
            for name, joint, peak in (
                ("holds", rf.RigidGround(friction=5.0, kinetic_friction=0.5), 10.4),
                ("slips", rf.RigidGround(friction=0.2), 10.4),
            )
            for count in (2, 4)
        },
    }  # fmt: skip


def seconds(system, ground, level):
    """Return the processor time of a run, and the run."""
    start = time.process_time()
    run = system.simulate(ground, accuracy=level, outputs=None, second_look=False)
    return time.process_time() - start, run


def measured(without, having, ground, level):
    """Return both times, their ratio and the steps."""
    for one in (without, having):
        seconds(one, ground, level)
    times = [[seconds(one, ground, level)[0] for one in (without, having)] for _ in range(ROUNDS)]
    bare, own = np.min(times, axis=0)
    steps = [int(seconds(one, ground, level)[1].attrs["solver_steps"]) for one in (without, having)]
    for one in (without, having):
        if int(seconds(one, ground, level)[1].overturned):
            print("overturns:", one.parts, flush=True)
    per_step = own / steps[1] / (bare / steps[0])
    return {
        "without [ms]": _shown(1e3 * bare), "with [ms]": _shown(1e3 * own),
        "ratio": _shown(own / bare), "steps without": steps[0], "steps with": steps[1],
        "ratio of a step": _shown(per_step),
    }  # fmt: skip


def _shown(number):
    return round(float(number), 2)


def main():
    warnings.simplefilter("ignore")
    words = sys.argv[1:]
    table = json.loads(DATA.read_text(encoding="utf-8")) if words else {}
    for name, (without, having, peak) in scenes().items():
        if words and not any(one in name for one in words):
            continue
        table[name] = {level: measured(without, having, motion(peak), level) for level in LEVELS}
        print(name, table[name], flush=True)
        DATA.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
