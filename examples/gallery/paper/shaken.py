"""What the scripts of Figs. 22 and 23 share: both frames under TCU128, and their drawing."""

from collections.abc import Callable
from itertools import product

import matplotlib.pyplot as plt
import worked_example
import xarray as xr
from matplotlib.figure import Figure

WAYS: dict[str, tuple[worked_example.Coupling, dict[int, float]]] = {
    "cascade, printed shape factor": ("cascade", worked_example.PRINTED),
    "coupled, shape factor of the members": ("coupled", worked_example.BY_MEMBERS),
}


def runs() -> dict[tuple[str, int, int], xr.Dataset]:
    """Shake both frames on three pads, in both ways."""
    motion = worked_example.tcu128()
    return {
        (way, storeys, ratio): worked_example.scene(
            storeys, ratio, coupling, shape_factors=shape_factors
        ).simulate(motion, output_step="0.02 s")
        for (way, (coupling, shape_factors)), storeys, ratio in product(
            WAYS.items(), worked_example.STOREYS, worked_example.FREQUENCY_RATIOS
        )
    }


def tell(found: dict[tuple[str, int, int], xr.Dataset], peak: Callable[[xr.Dataset], str]) -> None:
    """Print a peak of every run."""
    for way in WAYS:
        print(f"{way}:")
        for storeys in worked_example.STOREYS:
            cells = (peak(found[way, storeys, ratio]) for ratio in worked_example.FREQUENCY_RATIOS)
            print(f"  {storeys} storeys, beta 20, 40, 60: " + ", ".join(cells))


def draw(
    found: dict[tuple[str, int, int], xr.Dataset], name: str, factor: float, label: str
) -> Figure:
    """Draw a history of every run, a panel for each frame and way."""
    figure, grid = plt.subplots(2, 2, figsize=(9.0, 5.0), sharex=True, layout="constrained")
    for (way, storeys, ratio), run in found.items():
        axes = grid[worked_example.STOREYS.index(storeys), list(WAYS).index(way)]
        axes.plot(
            run.time, factor * run[name],
            color=worked_example.COLOURS[ratio], lw=0.9, label=rf"$\beta={ratio}$",
        )  # fmt: skip
    for axes, way in zip(grid[0], WAYS, strict=True):
        axes.set_title(way, fontsize="medium")
    for row, storeys in zip(grid, worked_example.STOREYS, strict=True):
        row[0].set_ylabel(f"{storeys} storeys\n{label}")
    for axes in grid[1]:
        axes.set(xlabel="time [s]", xlim=(0.0, 30.0))
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure
