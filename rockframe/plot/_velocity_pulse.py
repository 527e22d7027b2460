"""The velocity of a motion, of the pulse in it, and of what the pulse leaves."""

from typing import TYPE_CHECKING, Final, cast

import numpy as np

from rockframe.errors import ComponentError, shown
from rockframe.plot._axes import grid
from rockframe.plot._panels import Panels, sheet

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion, VelocityPulse
    from rockframe.plot._panels import AxesLike

_MOTION: Final = "#999999"
_PULSE: Final = "#cc6677"
_RESIDUAL: Final = "#222255"


def velocity_pulse(
    pulse: "VelocityPulse[GroundMotion]",
    *,
    ax: "AxesLike" = None,
    title: str | None = None,
) -> Panels:
    """Draw the velocity of a motion with its pulse, and the residual velocity below.

    Parameters
    ----------
    pulse : VelocityPulse
        As :meth:`rockframe.GroundMotion.velocity_pulse` gives it.
    ax : two Axes, optional
        What is drawn in; a new figure unless given.
    title : str, optional
        Title of a new figure; name of the motion, period and verdict unless given.

    Returns
    -------
    Panels
        Time is that of the motion, the still ground before it is at negative times.

    Raises
    ------
    ComponentError
        Not a velocity pulse, or not two Axes.
    """
    from rockframe.measures import velocity_and_displacement
    from rockframe.motion import VelocityPulse

    if not isinstance(cast("object", pulse), VelocityPulse):
        msg = (
            "rf.plot.velocity_pulse needs a VelocityPulse, as motion.velocity_pulse() gives it, "
            f"got {shown(pulse)}"
        )
        raise ComponentError(msg)
    on = sheet(
        ax, "velocity_pulse", ("the motion", "the residual motion"), (8.0, 4.6),
        lambda figure: figure.subplots(2, 1, sharex=True, sharey=True),
    )  # fmt: skip
    on.entitle(f"{pulse.extracted.name}: {pulse}", title)
    above, below = on.panels
    extracted, residual = (
        velocity_and_displacement(motion) for motion in (pulse.extracted, pulse.residual)
    )
    time = extracted["time"].to_numpy() - float(pulse.lead.m_as("s"))
    of_pulse = extracted["ground_velocity"].to_numpy()
    left = residual["ground_velocity"].to_numpy()
    above.plot(time, of_pulse + left, color=_MOTION, linewidth=1.0, label="motion")
    words = f"pulse, $T_p$ = {pulse.period.m_as('s'):.3g} s"
    above.plot(time, of_pulse, color=_PULSE, linewidth=1.8, label=words)
    below.plot(time, left, color=_RESIDUAL, linewidth=1.0, label="residual motion")
    reach = 1.1 * max(float(np.abs(of_pulse + left).max()), float(np.abs(left).max()))
    for axes in (above, below):
        axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
        axes.set(ylabel="ground velocity [m s$^{-1}$]", xlim=(time[0], time[-1]))
        axes.set_ylim(-reach, reach)
        axes.legend(loc="upper right", fontsize="small", frameon=False)
        grid(axes)
    below.set_xlabel("time [s]")
    return on.panels
