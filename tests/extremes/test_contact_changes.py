"""Scenes that once had endless contact changes."""

import numpy as np
import pytest

import rockframe as rf

pytestmark = pytest.mark.filterwarnings("ignore::rockframe.errors.ModelWarning")

HELD_AGAIN = [
    (2.3246231155778894, 12.816816816816818),
    (2.3246231155778894, 13.975975975975976),
    (2.3246231155778894, 13.981981981981981),
    (2.6060301507537686, 13.873873873873872),
    (3.0, 12.372372372372372),
]
"""Scales of the motion and frequency ratios, found among 200 000 runs."""
SLIP_FOR_A_MOMENT = [
    (2.7152542372881356, 19.214428857715433),
    (2.7627118644067794, 16.80160320641283),
    (2.9050847457627116, 18.541082164328657),
]
"""The same for sliding contacts shorter than a fixed step."""


def shaking(scale):
    samples = 4.0 * scale * np.sin(0.314 * np.arange(120))
    return rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.02 s")


def runs(slenderness, scale, frequency_ratio):
    block = rf.Block.from_size(radius="3 m", slenderness=slenderness, mass="50 t")
    pads = rf.TwoSpringSupport(frequency_ratio=frequency_ratio, damping_ratio=0.1)
    runs_found = {
        level: rf.System(block, pads).simulate(shaking(scale), free_vibration="2 s", accuracy=level)
        for level in ("fast", "standard", "reference")
    }
    for level, run in runs_found.items():
        assert run.status == 0
        assert run.sizes["event"] < 60
        difference = abs(run.peak_rotation / runs_found["reference"].peak_rotation - 1.0)
        assert difference < (2e-3 if level == "fast" else 1e-7)
    assert runs_found["reference"].energy_residual < 1e-10
    assert runs_found["standard"].energy_residual < 1e-7
    return runs_found


@pytest.mark.parametrize(("scale", "frequency_ratio"), HELD_AGAIN)
def test_a_corner_that_would_be_held_again_at_once_does_not_leave(scale, frequency_ratio):
    runs(4.5, scale, frequency_ratio)


@pytest.mark.parametrize(("scale", "frequency_ratio"), SLIP_FOR_A_MOMENT)
def test_short_slip_within_step_ends_in_time(scale, frequency_ratio):
    runs_found = runs(3.0, scale, frequency_ratio)
    lasting = [time for run in runs_found.values() for time in times_of_slips(run)]
    assert lasting
    assert max(lasting) > 1e-4


def times_of_slips(run):
    """Return the duration of each slip from separation into sliding contact to its end."""
    kinds, states = run.event_kind.to_numpy(), run.contact_state_after.to_numpy()
    slips = np.flatnonzero((kinds[:-1] == 1) & (states[:-1] != 3) & (kinds[1:] == 4))
    times = run.event_time.to_numpy()
    return list(times[slips + 1] - times[slips])


ENDS_OF_THE_CAP = [
    ("coupled", 0, 5.504, 21.29, 0.1943, 5746.0, 1.479, 5.519, 2.435e6, 0.4183),
    ("coupled", 3, 1.2071480057, 58.649974610, 0.0499579831, 19137.332483, 3.065032015,
     4.4078264945, 1370863.594112, 0.0637214454),
    ("cascade", 3, 0.5113126369, 23.969473984, 0.1533159299, 216883.74517992, 3.3882759339,
     5.5915806661, 2074065.8512037, 0.1007042120),
]  # fmt: skip
"""Stacks under strong shaking in both directions, found among 40 000: coupling, number of the
motion, its scale; frequency and damping ratio of the pads; mass, width and height of the block;
stiffness and damping ratio of the soil."""
FAR_FROM_THE_ROOT = [
    ("coupled", 3, 4.908, 13.85, 0.1651, 3924.0, 3.591, 9.047, 2.325e7, 0.5007),
]
"""A scene in which an event was located where its guard was still positive."""
BY_ROUNDING = (
    "coupled", 1, 5.904439798154963, 50.33506474945864, 0.205806381471432, 4333.677323920404,
    3.312061875043419, 9.079241722453189, 122799777.09683603, 0.4518113413673902,
)  # fmt: skip
"""A scene in which a guard was negative by its change within the rounding of time."""


def stack(coupling, ratio, damping_ratio, mass, width, height, stiffness, soil_damping):
    return rf.System(
        rf.Block(width=f"{width} m", height=f"{height} m", mass=f"{mass} kg"),
        rf.TwoSpringSupport(frequency_ratio=ratio, damping_ratio=damping_ratio),
        rf.CushionCap(height="0.9 m", mass=f"{0.4 * mass} kg"),
        rf.WinklerSoil(stiffness=f"{stiffness} Pa", damping_ratio=soil_damping),
        coupling=coupling,
    )


def in_both_directions(number):
    across, up = (
        rf.GroundMotion.stochastic(
            6.8,
            "5 km",
            seed=seed + number,
            stress_drop="20 MPa",
            source="one corner",
            time_step="0.01 s",
        )
        for seed in (29, 90)
    )
    return across.with_vertical(up)


@pytest.mark.parametrize("case", [*ENDS_OF_THE_CAP, *FAR_FROM_THE_ROOT])
def test_ends_do_not_chatter_at_one_instant(case):
    coupling, number, scale, *parts = case
    system, motion = stack(coupling, *parts), in_both_directions(number).scaled(scale)
    fast = system.simulate(motion, accuracy="fast", second_look=False)
    standard = system.simulate(motion)
    for run in (fast, standard):
        assert run.status in (0, 1)
        assert run.sizes["event"] < 200
    assert fast.status == standard.status
    assert abs(fast.peak_rotation / standard.peak_rotation - 1.0) < 2e-3
    assert standard.energy_residual < 1e-8


@pytest.mark.long
def test_rounding_of_time_makes_no_events():
    """Hundreds of contact changes on hard pads, but no endless sequence."""
    coupling, number, scale, *parts = BY_ROUNDING
    system, motion = stack(coupling, *parts), in_both_directions(number).scaled(scale)
    fast = system.simulate(motion, accuracy="fast", second_look=False)
    standard = system.simulate(motion)
    assert fast.status == standard.status == 0
    assert abs(fast.sizes["event"] - standard.sizes["event"]) < 10
