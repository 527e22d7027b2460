"""Figures of the analytic pulses."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

import rockframe as rf

ROWS = (
    ("ground_acceleration", r"$\ddot x_g$  [m s$^{-2}$]", "#333333"),
    ("ground_velocity", r"$\dot x_g$  [m s$^{-1}$]", "#222255"),
    ("ground_displacement", r"$x_g$  [m]", "#225522"),
)


def _side_by_side(motions: Mapping[str, rf.GroundMotion]) -> Figure:
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes = figure.subplots(len(ROWS), len(motions), sharex="col", sharey="row")
    for column, (title, motion) in enumerate(motions.items()):
        path = rf.measures.velocity_and_displacement(motion)
        last = float(path.time[-1])
        margin = 0.12 * last
        for row, (name, _, colour) in enumerate(ROWS):
            still = float(path[name][-1]) if name == "ground_displacement" else 0.0
            values = np.concatenate([[0.0, 0.0], path[name], [still, still]])
            time = np.concatenate([[-margin, 0.0], path.time, [last, last + margin]])
            axes[row, column].plot(time, values, color=colour, lw=1.1)
            axes[row, column].axhline(0.0, color="0.8", lw=0.5, zorder=0)
        axes[0, column].set_title(title, fontsize="medium")
        axes[-1, column].set(xlabel="time [s]", xlim=(-margin, last + margin))
    for row, (_, label, _) in enumerate(ROWS):
        axes[row, 0].set_ylabel(label)
    figure.align_ylabels(axes[:, 0])
    return figure


def cycloidal_pulses() -> Figure:
    """Draw types A, B and C, all of v_p = 0.5 m/s and T_p = 1 s."""
    given = "0.5 m/s", "1 s"
    return _side_by_side(
        {
            "type A": rf.GroundMotion.type_a_pulse(*given),
            "type B": rf.GroundMotion.type_b_pulse(*given),
            "type C$_1$": rf.GroundMotion.type_c_pulse(*given),
            "type C$_2$": rf.GroundMotion.type_c_pulse(*given, order=2),
        }
    )


def wavelets() -> Figure:
    """Draw wavelets and impulses of comparable size."""
    made = rf.GroundMotion
    return _side_by_side(
        {
            "Ricker, symmetric": made.ricker_wavelet("3 m/s^2", "1 s"),
            "Ricker, antisymmetric": made.ricker_wavelet("3 m/s^2", "1 s", antisymmetric=True),
            r"Mavroeidis, $\gamma=2$, $\nu=90°$": made.mavroeidis_papageorgiou_pulse(
                "0.5 m/s", "1 Hz", 2, "90 deg"
            ),
            "double impulse": made.double_impulse("0.5 m/s", "0.5 s", "0.25 s"),
        }
    )


def velocity_pulse() -> Figure:
    """Draw the pulse that is found in a synthetic motion to which one was added."""
    shaking = rf.GroundMotion.stochastic(6.5, "15 km", seed=1).resampled("0.01 s")
    pulse = rf.GroundMotion.mavroeidis_papageorgiou_pulse("80 cm/s", "0.5 Hz", 2.2, "0 deg")
    samples = shaking.si.horizontal.samples
    samples = samples + pulse.si.at(np.arange(samples.size) * shaking.si.time_step - 8.0)
    motion = rf.GroundMotion.from_arrays((samples, "m/s^2"), "0.01 s")
    found = motion.velocity_pulse()
    above, _ = rf.plot.velocity_pulse(found, title=str(found))
    return above.get_figure(root=True)
