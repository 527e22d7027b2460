"""The accessor ``dataset.rockframe`` of datasets: figures, tables and a summary of results."""

import math
from typing import TYPE_CHECKING, Any

import xarray as xr

from rockframe.errors import RockframeError
from rockframe.suggestions import suggests_names

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from rockframe.plot import Player
    from rockframe.simulation.system import System
    from rockframe.units.display import UnitsLike

_DIMENSIONS = "over"
_CARE = "to be used with care"
_SHOWN = (
    "peak_rotation",
    "peak_relative_rotation",
    "overturning_time",
    "first_uplift_time",
    "impact_count",
    "energy_residual",
)


@xr.register_dataset_accessor("rockframe")
@suggests_names
class RockframeAccessor:
    """Figures, tables and a summary of a result of rockframe, also of one read from a file.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
    >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
    >>> panels = run.rockframe.plot(rotation="deg")
    >>> run.rockframe.table("events").event_kind[0]
    'uplift'
    >>> run.rockframe.system.parts.block == system.parts.block
    True
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def __dir__(self) -> list[str]:
        return ["player", "plot", "summary", "system", "table", "verdict"]

    def plot(self, **options: Any) -> Any:
        """Draw the dataset with the function of :mod:`rockframe.plot` that draws its kind.

        Parameters
        ----------
        **options
            Arguments of that function.

        Returns
        -------
        matplotlib.axes.Axes or rockframe.plot.Panels

        Raises
        ------
        SchemaError
            There is no function that draws such a dataset.
        """
        from rockframe import plot
        from rockframe.plot._checks import figure_function_name

        return getattr(plot, figure_function_name(self._dataset))(self._dataset, **options)

    def player(
        self, path: "str | Path | None" = None, *, overwrite: bool = False, **options: Any
    ) -> "Player":
        """Make a page that plays a run, as :func:`rockframe.plot.player` does.

        Parameters
        ----------
        path : str or Path, optional
            File to write, ending in ``.html``; none is written unless given.
        overwrite : bool, optional
            As for :meth:`rockframe.plot.Player.save`.
        **options
            Arguments of :func:`rockframe.plot.player`.

        Returns
        -------
        rockframe.plot.Player
            Notebooks show it.

        Raises
        ------
        SchemaError, UnitsError, ComponentError, FileError
            As :func:`rockframe.plot.player` and :meth:`rockframe.plot.Player.save`.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
        >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
        >>> run.rockframe.player().to_html()[:15]
        '<!doctype html>'
        """
        from rockframe import plot

        player = plot.player(self._dataset, **options)
        if path is not None:
            player.save(path, overwrite=overwrite)
        return player

    def table(self, contents: str = "scalars", *, units: "UnitsLike" = None) -> "pd.DataFrame":
        """Convert the dataset to a table, as :func:`rockframe.table` does.

        Parameters
        ----------
        contents : {"scalars", "histories", "events"}, optional
            Contents of the rows.
        units : mapping of str to str, optional
            Units by kind of quantity, such as ``{"angle": "deg"}``.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        SchemaError, ComponentError
            As :func:`rockframe.table`.

        Examples
        --------
        >>> import rockframe as rf
        >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"))
        >>> run = system.simulate(rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz"))
        >>> run.rockframe.table(units={"angle": "deg"})["peak_rotation [°]"].round(2).tolist()
        [2.63]
        """
        from rockframe.results.table import table

        return table(self._dataset, contents, units=units)

    @property
    def system(self) -> "System":
        """The simulated system, as :meth:`rockframe.System.from_dataset` builds it."""
        from rockframe.simulation.system import System

        return System.from_dataset(self._dataset)

    @property
    def verdict(self) -> str:
        """The outcome in one sentence, of a run or of a selection of cases."""
        from rockframe.studies.verdicts import verdict_of_study

        return verdict_of_study(self._dataset)

    @property
    def summary(self) -> str:
        """Contents and outcome of the dataset, in a few lines."""
        lines = [str(self._dataset.attrs.get("title", "")), self.verdict]
        for name, words in self._rows().items():
            lines.append(f"{name}{' ' if name == _DIMENSIONS else ': '}{words}")
        return "\n".join(filter(None, lines))

    def _rows(self) -> dict[str, str]:
        """Return what the dataset is a result of, and its main numbers."""
        from rockframe.results.variables.variable import unit_suffix_of
        from rockframe.studies.sweeps.labelling import cautions_of_result

        data = self._dataset
        cautions = cautions_of_result(data)
        care = {_CARE: "; ".join(cautions)} if cautions else {}
        described = (name for name in ("model", "motion", "accuracy") if name in data.attrs)
        rows = care | {name: str(data.attrs[name]) for name in described}
        if len(data.sizes) > 0:
            rows[_DIMENSIONS] = ", ".join(f"{dim} ({n})" for dim, n in data.sizes.items())
        for name in _SHOWN:
            if name in data and data[name].ndim == 0 and not math.isnan(data[name].item()):
                rows[name] = f"{data[name].item():.4g}{unit_suffix_of(data[name].attrs)}"
        return rows

    def __repr__(self) -> str:
        return self.summary

    def _repr_html_(self) -> str:
        from rockframe.notebook import html_summary, sparkline
        from rockframe.units import degrees_text

        value = self._dataset
        kind = str(value.attrs.get("title", ""))
        first = self.verdict or kind or "Dataset"
        rows = {"result": kind} if self.verdict and kind else {}
        rows |= {name.replace("_", " "): words for name, words in self._rows().items()}
        for name in ("peak_rotation", "uplift_angle", "overturning_angle"):
            if name in value and value[name].ndim == 0:
                rows[name.replace("_", " ")] = degrees_text(value[name].item())
        history = value.get("rotation")
        trace = ""
        if history is not None and history.ndim == 1:  # of a case of a sweep, up to its end
            trace = sparkline(history.dropna(history.dims[0]).to_numpy().tolist())
        return html_summary(first, rows, self._drawing(), trace)

    def _drawing(self) -> str:
        """Draw the scene of a result that stores its system."""
        if "system_json" not in self._dataset.attrs:
            return ""
        from rockframe.notebook import shapes_svg
        from rockframe.plot._checks import system_of_run
        from rockframe.system.geometry import geometry_of, scene_polygons

        try:
            system = system_of_run(self._dataset, "card")
        except RockframeError:  # for example a user's own component that is not registered
            return ""
        return shapes_svg(scene_polygons(geometry_of(system.assembly)))
