"""The paper's worked example (section 4.3): two frames on pads, a cap and soil.

Sizes of Table 2, cap H/20 high, pads xi = 0.10, soil xi_s = 0.20. The paper gives no width and no
mass of the cap: here it is as wide and as deep as the plan, 4 m, and of concrete, 2500 kg/m^3.

Run as a script, with the file of the record TCU128 N, this prints the tables of the manual's page
"Validation: frames on soil": ``python tests/published/frames.py PEERSMD_CHICHI_TCU128-N.AT2``.
"""

import argparse
import functools
import itertools
import math
import timeit
import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import rockframe as rf
from rockframe.errors import ModelWarning

FLOORS = (3, 6)
BETAS = (20, 40, 60)
SOILS = (3, 6, 9, 12)  # k0 [MPa]
K0 = 9  # of the cases under TCU128
COUPLINGS = ("cascade", "coupled")
MASSES = {3: 45.8, 6: 99.0}  # [t]
SHAPE_FACTORS = {
    "printed": {3: 1.153, 6: 0.380},
    "by Eq. (22)": {3: 2.774, 6: 2.923},  # of the members, test_frames.py
}
ROTATION = 0.10  # at the start of the free response [rad]
DURATION = 20.0  # of the free response [s]
LEAST_PEAK = 0.02  # smaller swings are not counted [rad]
GRID = 0.05  # of scale factors
ROUNDS = 25  # of which the fastest is timed
GRAVITY = 9.81
CONCRETE = 2500.0


# Scenes ---------------------------------------------------------------------------------------


def frame(floors, shape="printed", *, size=1.0):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # expected in the tests
        return rf.FrameEquivalent(
            width=f"{4 * size} m",
            height=f"{3 * floors * size} m",
            mass=f"{MASSES[floors] * size**3} t",
            shape_factor=SHAPE_FACTORS[shape][floors],
        )


def pads(beta, xi=0.10):
    return rf.TwoSpringSupport(frequency_ratio=beta, damping_ratio=xi)


def cap(floors, *, density=CONCRETE, size=1.0):
    return rf.CushionCap(
        height=f"{3 * floors * size / 20} m", density=f"{density} kg/m^3", depth=f"{4 * size} m"
    )


def soil(k0=K0):
    return rf.WinklerSoil(stiffness=f"{k0} MPa", damping_ratio=0.20)


def scene(
    floors, beta, coupling, *, k0=K0, shape="printed", xi=0.10, density=CONCRETE, size=1.0
):  # fmt: skip
    """Return a frame on its foundation; `size` scales both on the same soil, k0 with the depth."""
    return rf.System(
        frame(floors, shape, size=size),
        pads(beta, xi),
        cap(floors, density=density, size=size),
        soil(k0 * size),
        coupling=coupling,
        gravity=f"{GRAVITY} m/s^2",
    )


def tcu128(path):
    """Read the record from 30 to 60 s."""
    return rf.GroundMotion.read(path).window("30 s", "60 s")


# Free response --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Free:
    """A free response, swing by swing.

    A swing lies between two passages of the upright position. A swing cut by the end of the run is
    excluded, and so are all from the first whose peak is below `LEAST_PEAK`.
    """

    time: np.ndarray
    rotation: np.ndarray
    vertical: np.ndarray

    @cached_property
    def passages(self):
        """The first sample of each swing but the first."""
        return np.flatnonzero(np.diff(np.signbit(self.rotation))) + 1

    @cached_property
    def swings(self):
        """Times and sizes of the peaks of the rotation, and sizes of those of |y|."""
        rows = []
        for part in np.split(np.arange(len(self.time)), self.passages)[:-1]:
            size = np.abs(self.rotation[part])
            if size.max() < LEAST_PEAK:
                break
            peak_time = self.time[part[np.argmax(size)]]
            rows.append((peak_time, size.max(), np.abs(self.vertical[part]).max()))
        return np.array(rows).T

    @property
    def first_passage(self):
        return self.time[self.passages[0]]

    @property
    def second_peak(self):
        """The largest rotation after the first passage."""
        return np.abs(self.rotation[self.passages[0] :]).max()

    @property
    def second_peak_time(self):
        return self.swings[0][1]

    @property
    def rise(self):
        """The largest y."""
        return self.vertical.max()

    @property
    def later_rise(self):
        """The largest y after the first passage."""
        return self.vertical[self.passages[0] :].max()

    @property
    def later_height(self):
        """The largest |y| after the first passage."""
        return np.abs(self.vertical[self.passages[0] :]).max()

    def _logarithm(self, row):
        """Return the logarithm of the first peak over the last."""
        return math.log(self.swings[row][0] / self.swings[row][-1])

    @property
    def decay(self):
        """Rate of attenuation of the rotation's peaks, from the first to the last [1/s]."""
        return self._logarithm(1) / self.swings[0][-1]

    @property
    def vertical_decay(self):
        """Rate of attenuation of the peaks of |y| in the same swings [1/s]."""
        return self._logarithm(2) / self.swings[0][-1]

    @property
    def decrement(self):
        """Logarithmic decrement per swing."""
        return self._logarithm(1) / (len(self.swings[1]) - 1)


def free(system):
    """Release a system from 0.10 rad."""
    run = system.simulate(
        duration=f"{DURATION} s",
        initial=rf.InitialState(rotation=f"{ROTATION} rad"),
        output_step="0.005 s",
    )
    return Free(*(run[name].to_numpy() for name in ("time", "rotation", "vertical_displacement")))


def free_from_the_soil(floors, beta, k0, shape="printed"):
    """Return total and second stage of a cascade whose first stage has the initial rotation.

    The acceleration of the cap's top comes from differences of its path in steps of 2 ms.
    """
    step = 0.002
    run = rf.System(
        frame(floors, shape), cap(floors), soil(k0), gravity=f"{GRAVITY} m/s^2"
    ).simulate(
        duration=f"{DURATION} s",
        initial=rf.InitialState(rotation=f"{ROTATION} rad"),
        output_step=f"{step} s",
    )  # fmt: skip
    height, own = 3.0 * floors, 1e3 * MASSES[floors]
    cap_height = height / 20.0
    cap_mass = CONCRETE * 16.0 * cap_height
    centre = (own * (cap_height + height / 2.0) + cap_mass * cap_height / 2.0) / (own + cap_mass)
    rotation, vertical = run.rotation.to_numpy(), run.vertical_displacement.to_numpy()
    across = run.horizontal_displacement.to_numpy() + (cap_height - centre) * np.sin(rotation)
    upwards = vertical + (cap_height - centre) * np.cos(rotation)
    acceleration = [
        np.pad(np.diff(path, 2) / step**2, 1, mode="edge") for path in (across, upwards)
    ]
    motion = rf.GroundMotion.from_arrays(
        (acceleration[0], "m/s^2"), f"{step} s", vertical=(acceleration[1], "m/s^2")
    )
    second = rf.System(frame(floors, shape), pads(beta), gravity=f"{GRAVITY} m/s^2").simulate(
        motion
    )
    total = Free(
        run.time.to_numpy(),
        rotation + second.rotation.to_numpy(),
        vertical + second.vertical_displacement.to_numpy(),
    )
    return total, float(second.peak_rotation)


# Response to the record -----------------------------------------------------------------------


@dataclass(frozen=True)
class Shaken:
    """Peaks of rotation [rad] and of |y| [m], and attributes of the run."""

    rotation: float
    vertical: float
    overturned: bool
    impacts: int


def shaken(system, motion):
    run = system.simulate(motion)
    return Shaken(
        float(run.peak_rotation),
        float(np.abs(run.vertical_displacement).max()),
        bool(run.overturned),
        int(run.impact_count),
    )


def overturns(system, motion, factor=1.0):
    """Tell whether the scaled motion overturns a system, during it or in 10 s after it."""
    run = system.simulate(motion.scaled(factor), free_vibration="10 s", outputs=None)
    return bool(run.overturned)


def overturning_factor(system, motion, *, step=GRID, most=15.0):
    """Return the least factor found that overturns, on a grid and then by bisection to 1 %.

    Overturning is not monotone in the factor: between two points of the grid a smaller one may be
    overlooked. The system stands at 0.99 of the factor given, or nearer.
    """
    for i in range(1, round(most / step) + 1):
        if overturns(system, motion, i * step):
            low, high = (i - 1) * step, i * step
            break
    else:
        return math.nan
    while high - low > 0.01 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturns(system, motion, middle) else (middle, high)
    return high


# The cascade against the coupled model --------------------------------------------------------


@dataclass(frozen=True)
class Beside:
    """A cascade and the coupled model of the same scene; pairs in this order.

    `ratios` are the cascade's measures over those of the coupled model, `seconds` the times of the
    fastest of some runs without histories, infinite if none was requested.
    """

    ratios: tuple[float, ...]
    uplifts: tuple[float, ...]
    impacts: tuple[int, ...]
    steps: tuple[int, ...]
    seconds: tuple[float, ...]


def _beside(measures, runs, calls, rounds):
    first, second = measures
    best = [math.inf, math.inf]
    for _ in range(rounds):
        for place, call in enumerate(calls):
            best[place] = min(best[place], timeit.timeit(call, number=1))
    return Beside(
        tuple(a / b for a, b in zip(first, second, strict=True)),
        tuple(float(run.first_uplift_time) for run in runs),
        tuple(int(run.impact_count) for run in runs),
        tuple(int(run.attrs["solver_steps"]) for run in runs),
        tuple(best),
    )


def shaken_beside(motion, floors, shape, beta, *, rounds=0):
    """Compare both models under the record: peak rotation."""
    systems = [scene(floors, beta, coupling, shape=shape) for coupling in COUPLINGS]
    calls = [functools.partial(system.simulate, motion, outputs=None) for system in systems]
    runs = [call() for call in calls]
    return _beside([(float(run.peak_rotation),) for run in runs], runs, calls, rounds)


def released_beside(floors, beta, *, rounds=0):
    """Compare both models in free response, printed mu: second peak, its time, attenuation."""
    systems = [scene(floors, beta, coupling) for coupling in COUPLINGS]
    start = {
        "duration": f"{DURATION} s",
        "initial": rf.InitialState(rotation=f"{ROTATION} rad"),
        "outputs": None,
    }
    calls = [functools.partial(system.simulate, **start) for system in systems]
    responses = [free(system) for system in systems]
    measures = [(run.second_peak, run.second_peak_time, run.decay) for run in responses]
    return _beside(measures, [call() for call in calls], calls, rounds)


# Tables of the manual -------------------------------------------------------------------------


def print_free(shape):
    print(f"\nFree response, mu {shape}: second peak [rad] at its time [s], later rise [m], decay")
    for floors, beta in itertools.product(FLOORS, BETAS):
        for coupling, k0 in [("cascade", K0), *(("coupled", k0) for k0 in SOILS)]:
            run = free(scene(floors, beta, coupling, k0=k0, shape=shape))
            where = "any" if coupling == "cascade" else k0
            print(
                f"| {floors} | {beta} | {coupling}, {where} | {run.first_passage:.2f} "
                f"| {run.second_peak:.4f} | {run.second_peak_time:.2f} | {run.rise:.4f} "
                f"| {run.later_rise:.4f} | {run.later_height:.4f} | {run.decay:.4f} "
                f"| {run.vertical_decay:.4f} | {run.decrement:.4f} |"
            )


def print_from_the_soil():
    print("\nInitial rotation given to the first stage: second peak [rad], later rise, decay")
    for shape, floors, beta, k0 in itertools.product(SHAPE_FACTORS, FLOORS, BETAS, SOILS):
        total, second = free_from_the_soil(floors, beta, k0, shape)
        print(
            f"| {shape} | {floors} | {beta} | {k0} | {total.second_peak:.4f} "
            f"| {total.later_rise:.4f} | {total.decay:.4f} | stage 2: {second:.4f} |"
        )


def print_shaken(motion):
    print("\nTCU128: peak rotation [rad], peak |y| [m], impacts")
    for shape, floors, beta in itertools.product(SHAPE_FACTORS, FLOORS, BETAS):
        for coupling in COUPLINGS:
            run = shaken(scene(floors, beta, coupling, shape=shape), motion)
            print(
                f"| {shape} | {floors} | {beta} | {coupling} | {run.rotation:.4f} "
                f"| {run.vertical:.4f} | {run.overturned} | {run.impacts} |"
            )


def print_soils(motion):
    print("\nTCU128: peak rotation [rad] for k0 = 3, 6, 9, 12 MPa")
    for shape, floors, beta in itertools.product(SHAPE_FACTORS, FLOORS, BETAS):
        for coupling in COUPLINGS:
            peaks = [
                shaken(scene(floors, beta, coupling, k0=k0, shape=shape), motion).rotation
                for k0 in SOILS
            ]
            print(f"| {shape} | {floors} | {beta} | {coupling} |", *(f"{x:.4f} |" for x in peaks))


def print_factors(motion):
    print(f"\nTCU128: least factor found that overturns, grid {GRID}, then bisection to 1 %")
    for shape, floors, beta in itertools.product(SHAPE_FACTORS, FLOORS, BETAS):
        factors = [
            overturning_factor(scene(floors, beta, coupling, shape=shape), motion)
            for coupling in COUPLINGS
        ]
        print(f"| {shape} | {floors} | {beta} |", *(f"{factor:.4g} |" for factor in factors))


def print_caps(motion):
    print("\nTCU128, six storeys: peak over theta for other densities of the cap")
    for shape, beta, coupling in itertools.product(SHAPE_FACTORS, BETAS, COUPLINGS):
        peaks = []
        for density in (1.0, 250.0, 500.0, 750.0, 1000.0, 1250.0, 2500.0, 5000.0):
            system = scene(6, beta, coupling, shape=shape, density=density)
            run = system.simulate(motion, free_vibration="10 s", outputs=None)
            peaks.append(f"{float(run.peak_relative_rotation):.3f} |")
        print(f"| {shape} | {beta} | {coupling} |", *peaks)


def print_shaken_beside(motion):
    print("\nTCU128: peak, cascade over coupled; lifts from the pads [s]; steps; milliseconds")
    for shape, floors, beta in itertools.product(SHAPE_FACTORS, FLOORS, BETAS):
        both = shaken_beside(motion, floors, shape, beta, rounds=ROUNDS)
        lifts = ("no" if math.isnan(time) else f"{time:.1f} s" for time in both.uplifts)
        print(
            f"| {floors}, {shape} | {beta} | {both.ratios[0]:.2f} |",
            *(f"{cell} |" for cell in (*lifts, *both.steps)),
            *(f"{1e3 * spent:.0f} |" for spent in both.seconds),
        )


def print_released_beside():
    print("\nFree response, mu printed: cascade over coupled; impacts; steps; milliseconds")
    for floors, beta in itertools.product(FLOORS, (BETAS[0], BETAS[-1])):
        both = released_beside(floors, beta, rounds=ROUNDS)
        print(
            f"| {floors} | {beta} |",
            *(f"{ratio:.2f} |" for ratio in both.ratios[:2]),
            f"{both.ratios[2]:.1f} |",
            *(f"{cell} |" for cell in (*both.impacts, *both.steps)),
            *(f"{1e3 * spent:.0f} |" for spent in both.seconds),
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record", help="the file of TCU128, component N")
    motion = tcu128(parser.parse_args().record)
    warnings.simplefilter("ignore", ModelWarning)
    for shape in SHAPE_FACTORS:
        print_free(shape)
    print_from_the_soil()
    print_shaken(motion)
    print_soils(motion)
    print_factors(motion)
    print_caps(motion)
    print_shaken_beside(motion)
    print_released_beside()


if __name__ == "__main__":
    main()
