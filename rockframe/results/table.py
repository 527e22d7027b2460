"""Results as tables: a row for each run, for each sample or for each event."""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from enum import StrEnum
from typing import Any, Final

import pandas as pd
import xarray as xr

from rockframe.arguments import checked_choice, checked_dataset, is_iterable
from rockframe.errors import SchemaError
from rockframe.results.schema import SCHEMA
from rockframe.results.variables.bodies import BODY, RESTRAINER
from rockframe.results.variables.requests import POINT
from rockframe.results.variables.studies import CAUTIONS, MESSAGE, MOTION
from rockframe.results.variables.variable import EVENT, TIME, TRUTH, flag_words, unit_of
from rockframe.suggestions import with_hints
from rockframe.units import Unit
from rockframe.units.display import UnitsLike, display_units

_OWNER: Final = "table"
_RUN: Final = "run"


class Contents(StrEnum):
    """What the rows of a table are."""

    SCALARS = "scalars"
    HISTORIES = "histories"
    EVENTS = "events"


_PLACES: Final = (POINT, BODY, RESTRAINER)
_DIMENSION_OF: Final = {Contents.HISTORIES: TIME[0], Contents.EVENTS: EVENT[0]}
_MISSING: Final = {
    Contents.SCALARS: "rf.table(response, 'histories') and 'events' give what is along time",
    Contents.HISTORIES: "a run with outputs=None keeps none, rf.concat only with histories=True",
    Contents.EVENTS: "rf.concat keeps none; give the runs themselves",
}


@with_hints()
def table(
    runs: xr.Dataset | Iterable[xr.Dataset] | Mapping[Any, xr.Dataset],
    contents: str = Contents.SCALARS,
    *,
    units: UnitsLike = None,
) -> pd.DataFrame:
    """Convert results to a pandas DataFrame with units in the column headings.

    Parameters
    ----------
    runs : xarray.Dataset, or iterable or mapping of them
        A run, several runs, or runs joined by :func:`rockframe.concat`; also any other
        dataset of rockframe. The keys of a mapping are the labels of its runs.
    contents : {"scalars", "histories", "events"}, optional
        One row for each run; for each of its samples; or for each of its events.
    units : mapping of str to str, optional
        Units by kind of quantity, as for figures (:mod:`rockframe.plot`), such as
        ``{"force": "kN", "angle": "deg"}``; those of the datasets unless given.

    Returns
    -------
    pandas.DataFrame
        Column headings are the name and unit, such as ``peak_rotation [rad]``, or only the
        name if there is no unit or it is 1. Flags are words, such as ``right``; truth values
        are True and False; means of them are numbers. A variable over points, bodies or
        restrainers has a column for each of these, such as ``peak_body_slip 1 [m]``.

        The index of joined runs has their dimensions, with one row for each combination. Variables
        of different dimensions, such as responses over the intensity and intensities over the
        response, have separate rows, one below the other, in which the other dimensions are
        missing; pass ``dataset[["name"]]`` to convert only some variables. The index of a single
        run, or of several, has the name of the motion, if all runs have one, and coordinates
        without dimension; then the number of the run in the list, if these do not distinguish
        the runs. Histories add ``time [s]``, events their number.

    Raises
    ------
    SchemaError
        Not a dataset, or one without such contents.
    ComponentError
        Unknown contents, or a unit for an unknown kind of quantity.
    UnitsError
        A unit that does not fit its kind of quantity.

    Examples
    --------
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="0.8 m", height="4 m", mass="2 t"), rf.RigidGround())
    >>> pulse = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
    >>> response = system.simulate(pulse, free_vibration="2 s")
    >>> rf.table(response)["peak_rotation [rad]"].round(4).item()
    0.056
    >>> rf.table(response, "events").event_kind[0]
    'uplift'
    >>> rf.table(response, units={"angle": "deg"})["peak_rotation [°]"].round(2).item()
    3.21
    """
    kind = checked_choice(Contents, contents, owner=_OWNER, name="contents")
    chosen = display_units(units, owner=_OWNER)
    if isinstance(runs, xr.Dataset):
        run = _split_places(chosen.convert_dataset(runs), kind)
        if kind is Contents.SCALARS and not _dimensions(run, _names(run, kind)):
            return _stacked_rows([run], kind, _labels([run]))
        return _rows(run, kind)
    labels: pd.MultiIndex | pd.Index | None = None
    several: Any = runs
    if isinstance(runs, Mapping):
        labels, several = _keys(runs), runs.values()
    elif not is_iterable(several) or isinstance(several, str | xr.DataArray):
        several = [several]
    items = [
        _split_places(chosen.convert_dataset(checked_dataset(run, owner=_OWNER)), kind)
        for run in several
    ]
    if not items:
        msg = f"{_OWNER}: found no runs; expected one at least"
        raise SchemaError(msg)
    return _stacked_rows(items, kind, _labels(items) if labels is None else labels)


def _split_places(run: xr.Dataset, kind: Contents) -> xr.Dataset:
    """Split scalars over points, bodies or restrainers, and add the cautions of a single run."""
    if kind is not Contents.SCALARS or "status" not in run.data_vars:
        return run
    alone: dict[str, xr.DataArray | str] = {}
    if MESSAGE in run.coords and not run[MESSAGE].dims:  # no label of a single case
        run = run.reset_coords(MESSAGE)
    if CAUTIONS in run.attrs and MESSAGE not in run.variables and not run["status"].dims:
        alone[MESSAGE] = run.attrs[CAUTIONS]
    for name, values in run.data_vars.items():
        if name not in SCHEMA or SCHEMA[str(name)].dims not in _PLACES:
            continue
        (place,) = SCHEMA[str(name)].dims
        if place in values.dims and place in run.coords:
            for k, label in enumerate(run[place].to_numpy()):
                alone[f"{name} {label}"] = values.isel({place: k}, drop=True)
    return run.assign(alone)


def _stacked_rows(runs: Sequence[xr.Dataset], kind: Contents, labels: pd.Index) -> pd.DataFrame:
    frames = [_rows(run, kind) for run in runs]
    dims = {_dimensions(run, _names(run, kind)) for run in runs}
    if len(dims) > 1:
        msg = f"{_OWNER}: found datasets of different dimensions, {sorted(dims)}; expected the same"
        raise SchemaError(msg)
    if not any(dims):
        rows = pd.concat(frames, ignore_index=True)
        rows.index = labels
        return rows
    names = [*labels.names, *frames[0].index.names]
    return pd.concat(frames, keys=labels, names=names)


def _keys(runs: Mapping[Any, xr.Dataset]) -> pd.Index:
    keys = list(runs)
    if keys and all(isinstance(key, tuple) for key in keys):
        return pd.MultiIndex.from_tuples(keys)
    return pd.Index(keys, name=_RUN)


def _labels(runs: Sequence[xr.Dataset]) -> pd.Index:
    """Return index labels of runs: motions, scalar coordinates and, if these repeat, a number."""
    levels: dict[str, list[Any]] = {}
    motions = [run.attrs.get(MOTION) for run in runs]
    if all(isinstance(name, str) for name in motions) and MOTION not in runs[0].coords:
        levels[MOTION] = motions
    for name in runs[0].coords:
        if all(name in run.coords and not run[name].dims for run in runs):
            levels[_heading(name, runs[0].variables[name])] = [run[name].item() for run in runs]
    if len(set(zip(*levels.values(), strict=True))) < len(runs):
        levels[_RUN] = list(range(len(runs)))
    if len(levels) == 1:
        ((name, values),) = levels.items()
        return pd.Index(values, name=name)
    return pd.MultiIndex.from_arrays(list(levels.values()), names=list(levels))


def _rows(run: xr.Dataset, kind: Contents) -> pd.DataFrame:
    """Return the rows of a dataset, without the labels that all of them share."""
    names = _names(run, kind)
    if not names:
        msg = f"{_OWNER}: the dataset holds no {kind}; {_MISSING[kind]}"
        raise SchemaError(msg)
    groups = _dimension_groups(run, names)
    frames = [_rows_of(run, kind, group) for group in groups]
    if len(frames) == 1:
        return frames[0]
    below = pd.concat([frame.reset_index() for frame in frames], ignore_index=True)
    heads = [_heading(dim, run.variables[dim]) if dim in run.variables else dim
             for dim in _dimensions(run, names)]  # fmt: skip
    return below.set_index(heads)


def _dimension_groups(run: xr.Dataset, names: Sequence[str]) -> list[list[str]]:
    """Divide variables into groups, in each of which one has all dimensions of the others.

    A variable that fits into several groups joins the one with the fewest rows.
    """
    dims = {name: frozenset(run.variables[name].dims) for name in names}
    widest = [
        group
        for group in dict.fromkeys(dims.values())
        if not any(group < of for of in dims.values())
    ]
    groups: dict[frozenset[Hashable], list[str]] = {group: [] for group in widest}
    for name, variable_dims in dims.items():
        around = [group for group in widest if variable_dims <= group]
        groups[min(around, key=lambda group: math.prod(run.sizes[dim] for dim in group))].append(
            name
        )
    return list(groups.values())


def _rows_of(run: xr.Dataset, kind: Contents, names: list[str]) -> pd.DataFrame:
    """Return the rows of a group of variables."""
    dims = _dimensions(run, names)
    variables = run.variables
    if not dims:
        single = pd.DataFrame({name: [variables[name].values.item()] for name in names})
        return _with_headings(single, variables, names)
    part = run[names]
    part = part.drop_vars([name for name in part.coords if not variables[name].dims])
    frame = part.to_dataframe(dim_order=dims)
    if kind in _DIMENSION_OF and len(dims) > 1:
        # joined histories and events are as long as the longest of them
        floats = [name for name in names if variables[name].dtype.kind == "f"]
        frame = frame.dropna(how="all", subset=floats)
    beside = [str(name) for name in part.coords if name in frame.columns]
    heads = [_heading(n, variables[n]) if n in variables else n for n in frame.index.names]
    frame.index = frame.index.set_names(heads)
    return _with_headings(frame, variables, [*beside, *names])


def _with_headings(
    frame: pd.DataFrame, variables: Mapping[Any, xr.Variable], names: Sequence[str]
) -> pd.DataFrame:
    """Give columns their units, and words for flags."""
    columns = {
        _heading(name, variables[name]): _in_words(frame[name], variables[name]) for name in names
    }
    return pd.DataFrame(columns, index=frame.index)


def _names(run: xr.Dataset, kind: Contents) -> list[str]:
    """Find the variables of a kind."""
    dims_of = {str(name): set(run.variables[name].dims) for name in run.data_vars}
    if kind in _DIMENSION_OF:
        return [name for name, dims in dims_of.items() if _DIMENSION_OF[kind] in dims]
    still = {name: dims for name, dims in dims_of.items() if not {*TIME, *EVENT} & dims}
    scalars = [dims for name, dims in still.items() if name in SCHEMA and not SCHEMA[name].dims]
    # the dimensions of many runs are those of their scalars; an answer without scalars, such
    # as a spectrum, has a row for each of its points
    across = set[Hashable].union(*(scalars or still.values())) if still else set[Hashable]()
    return [name for name, dims in still.items() if dims <= across]


def _dimensions(run: xr.Dataset, names: Sequence[str]) -> tuple[Hashable, ...]:
    """Return the dimensions of variables, those of time and events last."""
    dims = dict.fromkeys(dim for name in names for dim in run.variables[name].dims)
    return tuple(sorted(dims, key=lambda dim: dim in (*TIME, *EVENT)))


def _heading(name: Hashable, values: xr.Variable) -> str:
    return head(str(name), unit_of(values.attrs))


def head_of(name: str) -> str:
    """Return the head of the column of a variable of the schema."""
    return head(name, unit_of(SCHEMA[name].attributes()))


def head(name: str, unit: object) -> str:
    """Return the head of a column: its name, and its unit where that is not 1."""
    return name if unit == Unit.ONE else f"{name} [{unit}]"


def _in_words(column: Any, values: xr.Variable) -> pd.Series:
    """Return flags as words, and truth values with gaps as nullable booleans.

    A mean of flags or of truth values has none of their values, and stays a number.
    """
    words = flag_words(values.attrs)
    if values.dtype == bool or not words or not column.dropna().isin(list(words)).all():
        return column
    if (*words.values(),) == TRUTH:
        return column.astype("boolean")
    return column.map(words)
