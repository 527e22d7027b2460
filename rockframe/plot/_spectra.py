"""A motion with its spectra, laid out as in Fig. 21 of the paper."""

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rockframe.plot._given import check_motion
from rockframe.plot._title import set_title

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockframe.motion import GroundMotion
    from rockframe.motion.quantities import ArrayLike, QuantityLike, RatioLike

_COLOURS = ("#222255", "#cc6677", "#117733", "#ddaa33", "#88ccee")
_RESOLUTION = "0.05 Hz"  # of short pulses; that of long records is finer
_PREFIX = {"horizontal": "", "vertical": "vertical_"}


def spectra(
    motion: "GroundMotion",
    periods: "ArrayLike | Iterable[QuantityLike] | None" = None,
    damping_ratios: "Iterable[RatioLike] | RatioLike" = (0.05,),
    *,
    component: str = "horizontal",
    title: str | None = None,
) -> "Figure":
    """Draw a motion along time, its response spectra and its Fourier spectrum.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    periods, damping_ratios : optional
        As for :func:`rockframe.measures.response_spectrum` [s], [1].
    component : {"horizontal", "vertical"}, optional
        Which acceleration.
    title : str, optional
        Title of the figure; the motion's name unless given.

    Returns
    -------
    matplotlib.figure.Figure
        Not yet shown nor saved. The response spectra are those of the pseudo-spectral
        acceleration.

    Raises
    ------
    UnitsError, ComponentError
        As for :func:`rockframe.measures.response_spectrum`.
    """
    from matplotlib.figure import Figure

    from rockframe.measures import (
        fourier_spectrum,
        response_spectrum,
        velocity_and_displacement,
    )

    check_motion(motion, "spectra")
    response = response_spectrum(motion, periods, damping_ratios, component=component)
    fourier = fourier_spectrum(motion, resolution=_RESOLUTION, component=component)
    history = velocity_and_displacement(motion, component=component)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    axes: Any = figure.subplot_mosaic(
        [["history", "history"], ["response", "fourier"]], height_ratios=[1.0, 1.7]
    )
    _history(axes["history"], history, f"{_PREFIX[str(component)]}ground_acceleration")
    _response(axes["response"], response)
    _fourier(axes["fourier"], fourier)
    set_title(figure, title or motion.name)
    return figure


def _history(axes: "Axes", dataset: xr.Dataset, name: str) -> None:
    time = dataset["time"].to_numpy()
    axes.plot(time, dataset[name], color="0.3", linewidth=0.8)
    axes.axhline(0.0, color="0.8", linewidth=0.5, zorder=0)
    axes.set_xlim(time[0], time[-1])
    axes.set_xlabel("time [s]")
    axes.set_ylabel("acceleration\n[m s$^{-2}$]")


def _response(axes: "Axes", dataset: xr.Dataset) -> None:
    drawn = dataset.isel(period=np.flatnonzero(dataset["period"].to_numpy() > 0.0))
    ratios = dataset["damping_ratio"].to_numpy().tolist()
    for place, ratio in enumerate(ratios):
        axes.semilogx(
            drawn["period"],
            drawn["pseudo_spectral_acceleration"].isel(damping_ratio=place),
            color=_COLOURS[place % len(_COLOURS)],
            linewidth=1.2,
            label=f"{100.0 * ratio:g} %",
        )
    axes.set_xlabel("period [s]")
    axes.set_ylabel("pseudo-spectral acceleration [m s$^{-2}$]")
    axes.set_ylim(bottom=0.0)
    axes.legend(title="damping", fontsize="small", title_fontsize="small", frameon=False)
    _grid(axes)


def _fourier(axes: "Axes", dataset: xr.Dataset) -> None:
    drawn = dataset.isel(frequency=slice(1, None))
    axes.semilogx(drawn["frequency"], drawn["fourier_amplitude"], color="0.3", linewidth=0.7)
    highest = float(drawn["fourier_amplitude"].max())
    if highest > 0.0:
        axes.set_yscale("log")
        axes.set_ylim(1e-4 * highest, 2.0 * highest)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("Fourier amplitude [m s$^{-1}$]")
    _grid(axes)


def _grid(axes: "Axes") -> None:
    axes.grid(visible=True, which="major", color="0.88", linewidth=0.6)
    axes.set_axisbelow(True)
