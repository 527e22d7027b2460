"""Joining of runs into one dataset, which keeps the attributes that all runs share."""

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np
import xarray as xr

from rockframe.arguments import checked_bool, checked_dataset, is_iterable, json_attribute
from rockframe.errors import SchemaError, short_repr
from rockframe.motion.display import motion_words
from rockframe.results.schema import SCHEMA, history_line, without_fill_values
from rockframe.results.variables.bodies import BODY, RESTRAINER
from rockframe.results.variables.studies import CAUTIONS, MESSAGE, MOTION
from rockframe.results.variables.variable import AFTER_END, EVENT, TIME
from rockframe.suggestions import with_hints
from rockframe.units import attached_unit

RUN_ATTRIBUTES: Final = frozenset(
    {
        "verdict",
        "overturned",
        "overturning_time",
        "overturning_direction",
        CAUTIONS,
        "certificate",
        "certificate_runs",
        "proof",
        "proof_verdict",
        "proof_bits",
        "solver_substeps",
        "solver_steps",
        "solver_rejected_steps",
        "solver_end_time",
        "end_state",
        "impacts_of_several_modes",
        "impacts_of_no_mode",
        "corners_held_without_pressing",
    }
)
"""Attributes that describe the outcome of one run; joined runs have none of them."""
CASE_COUNT: Final = "case_count"
"""Attribute with the number of cases of one sweep; joined sweeps do not keep it."""

MOTION_ATTRIBUTES: Final = ("motion_names", "motions_json")
"""Attributes that describe the motions of a sweep."""
SWEEP_ATTRIBUTES: Final = (*MOTION_ATTRIBUTES, "axes_json", "run_json", "study_sha256")
"""Attributes that every sweep has."""

_OWNER: Final = "concat"


@with_hints()
def concat(
    runs: Iterable[xr.Dataset] | Mapping[Any, xr.Dataset],
    dim: str = "run",
    labels: Sequence[Any] | np.ndarray | xr.DataArray | None = None,
    *,
    histories: bool = False,
) -> xr.Dataset:
    """Join runs, or datasets of joined runs, along a dimension.

    Parameters
    ----------
    runs : iterable of xarray.Dataset, or mapping of labels to them
        Results of :meth:`rockframe.System.simulate`, of
        :func:`rockframe.intensity_measures` or of this function.
    dim : str, optional
        The dimension, such as ``"scale"``; a new one, or one that all of them have.
    labels : sequence or DataArray, optional
        Values along the dimension, one for each run; a DataArray also gives them its
        attributes, such as ``units``. Those of a mapping are its keys unless given.
    histories : bool, optional
        Whether histories are joined too; their times must be the same in all runs.

    Returns
    -------
    xarray.Dataset
        The variables that all runs have, without events and, unless `histories`, without
        histories; NaN for bodies and restrainers that a run does not have. Where motions differ,
        or `dim` is ``"motion"``, their names are a coordinate ``motion``.

    Raises
    ------
    SchemaError
        No runs, something other than datasets, different numbers of labels and runs, or runs
        that do not fit one another.

    Notes
    -----
    An attribute is kept if every run has it with the same value. Attributes that describe the
    outcome of one run are always left out: the verdict with its certificate and proof, cautions,
    which become the coordinate `message`, numbers of the solver (`solver_steps` and others) and of
    unusual impacts, and the end state; and `case_count` of a sweep. Sweeps that differ only along
    one axis, or only in their motions, become one sweep. The order in which runs are joined
    therefore does not matter. `xarray.concat` with ``combine_attrs="drop_conflicts"`` keeps
    attributes that only some datasets have: if only some of the joined datasets contain runs that
    overturned, the result would state that none did.

    Examples
    --------
    >>> import rockframe as rf
    >>> block = rf.Block(width="0.8 m", height="4 m", mass="2 t")
    >>> system = rf.System(block, rf.RigidGround())
    >>> pulse = rf.GroundMotion.sine_pulse("1 m/s^2", "1 Hz")
    >>> scales = [1.0, 2.5, 9.0]
    >>> runs = [system.simulate(pulse.scaled(scale), free_vibration="5 s") for scale in scales]
    >>> study = rf.concat(runs, "scale", scales)
    >>> study.overturned.values
    array([False, False,  True])
    >>> "overturned" in study.attrs
    False
    """
    if isinstance(runs, Mapping) and not isinstance(runs, xr.Dataset):
        labels = list(runs) if labels is None else labels
        runs = runs.values()
    data = [checked_dataset(run, owner=_OWNER) for run in _each(runs)]
    if not data:
        msg = f"{_OWNER}: found no runs; expected one at least"
        raise SchemaError(msg)
    _check_dimension(data, dim)
    checked_bool(histories, owner=_OWNER, name="histories")
    left_out = (*EVENT, *AFTER_END) if histories else (*EVENT, *AFTER_END, *TIME)
    parts = [run.drop_dims(left_out, errors="ignore") for run in data]
    common = set[Any].intersection(*(set(part.data_vars) for part in parts))
    if not common:
        msg = (
            f"{_OWNER}: the runs share no variables besides histories and events; "
            "rf.table(runs, 'histories') puts histories one below the other"
        )
        raise SchemaError(msg)
    shared = [name for name in parts[0].data_vars if name in common]
    rows = [part[shared].drop_encoding() for part in parts]
    rows = [row if dim in row.dims else row.expand_dims(dim) for row in rows]
    if all(MESSAGE in row.coords or {CAUTIONS, "status"} <= {*row.attrs, *row} for row in rows):
        rows = [_with_messages(row, dim) for row in rows]
    _refuse_unlike_units(rows)
    try:
        joined = xr.concat(
            _with_motions(_with_all_labels(rows, dim), dim, labelled=labels is not None),
            dim=dim,
            data_vars="minimal",
            coords="different",
            compat="equals",
            join="exact",
            combine_attrs=_shared,
        )
    except ValueError as problem:
        msg = f"{_OWNER}: the runs do not fit one another: {problem}"
        raise SchemaError(msg) from problem
    _type_flags(joined)
    joined.attrs |= _as_one_sweep(data, dim, joined)
    joined.attrs["history"] = history_line(f"{joined.sizes[dim]} joined along {dim!r}")
    if labels is not None:
        joined = _labelled(joined, dim, labels)
    return without_fill_values(joined)


def _each(runs: object) -> Iterable[Any]:
    if is_iterable(runs) and not isinstance(runs, str | xr.Dataset | xr.DataArray):
        return runs
    msg = f"{_OWNER}: found {short_repr(runs)}; expected a list of datasets"
    raise SchemaError(msg)


def _check_dimension(runs: Sequence[xr.Dataset], dim: object) -> None:
    if not isinstance(dim, str) or dim in (*TIME, *EVENT, *AFTER_END):
        msg = (
            f"{_OWNER}: dim must be the name of a dimension of many runs, such as 'run' or "
            f"'scale', got {short_repr(dim)}"
        )
        raise SchemaError(msg)
    having = sum(dim in run.dims for run in runs)
    if 0 < having < len(runs):
        msg = f"{_OWNER}: {having} of {len(runs)} datasets have the dimension {dim!r}; expected "
        raise SchemaError(msg + "all or none")


def _with_messages(row: xr.Dataset, dim: str) -> xr.Dataset:
    """Return the cautions of a run as messages, and extend messages of joined runs along `dim`."""
    if MESSAGE in row.coords:
        message = row[MESSAGE].variable
        spread = message if dim in message.dims else message.expand_dims(dim)
        return row.assign_coords({MESSAGE: spread})
    texts = np.full(row["status"].shape, row.attrs[CAUTIONS], dtype=object)
    return row.assign_coords({MESSAGE: (row["status"].dims, texts, SCHEMA[MESSAGE].attributes())})


def _refuse_unlike_units(rows: Sequence[xr.Dataset]) -> None:
    """Refuse a variable in several units, which xarray would join into one without a unit."""
    for name in set[Any].union(*(set(row.variables) for row in rows)):
        units = dict.fromkeys(row[name].attrs.get("units") for row in rows if name in row.variables)
        if len(units) > 1:
            stated = " and ".join("no unit" if unit is None else str(unit) for unit in units)
            msg = f"{_OWNER}: {name} is in {stated}; put it into one unit in all of them"
            raise SchemaError(msg)


def _with_all_labels(rows: Sequence[xr.Dataset], dim: str) -> list[xr.Dataset]:
    """Extend rows to all bodies and restrainers that any of them has, with NaN."""
    places: dict[str, list[Any]] = {}
    for name in (*BODY, *RESTRAINER):
        labels = [row[name].to_numpy().tolist() for row in rows if name in row.coords]
        if name != dim and any(row_labels != labels[0] for row_labels in labels):
            places[name] = list(
                dict.fromkeys(label for row_labels in labels for label in row_labels)
            )
    return [
        row.reindex({n: all_labels for n, all_labels in places.items() if n in row.coords})
        for row in rows
    ]


def _type_flags(joined: xr.Dataset) -> None:
    """Return `flag_values` the type of their variables, which missing runs have made floats."""
    for name, values in [*joined.data_vars.items()]:
        if "flag_values" in values.attrs and values.dtype.kind == "f":
            flags = np.asarray(values.attrs["flag_values"], np.float64)
            joined[name] = values.astype(np.float64).assign_attrs(flag_values=flags)


def _with_motions(rows: Sequence[xr.Dataset], dim: str, *, labelled: bool) -> list[xr.Dataset]:
    """Add the names of motions to rows as a coordinate, unless they are a shared attribute.

    Labels tell runs apart that differ in the scale of a motion; without them the scale is added.
    """
    lacking = [row for row in rows if MOTION not in row.variables]
    names = [row.attrs.get(MOTION) for row in lacking]
    scaled = [motion_words(row.attrs) for row in lacking]
    several_scales = not labelled and len({*scaled}) > len({*names})
    words = iter(scaled if several_scales else names)
    named = all(isinstance(name, str) for name in names)
    alike = len(lacking) == len(rows) and len({*names}) == 1 and not several_scales
    along_another = any(MOTION in row.dims for row in rows)
    if not named or (dim != MOTION and (alike or along_another)):
        return list(rows)
    return [
        row.assign_coords(
            {MOTION: (dim, [next(words)] * row.sizes[dim], SCHEMA[MOTION].attributes())}
        )
        if MOTION not in row.variables
        else row
        for row in rows
    ]


def _shared(values: Sequence[Mapping[Any, Any]], context: object = None) -> dict[Any, Any]:
    """Return the attributes that are equal in all runs, without those of the outcome of one run."""
    del context
    first, *others = values
    return {
        name: value
        for name, value in first.items()
        if name not in {*RUN_ATTRIBUTES, CASE_COUNT}
        and all(name in other and _same(value, other[name]) for other in others)
    }


_EQUAL_ATTRIBUTES: Final = (
    "axes_json", "run_json", "accuracy", "system_json", "function", "spectral_period",
    "rockframe_version",
)  # fmt: skip
"""Attributes that are equal in sweeps that differ only along one axis or in their motions."""


def _as_one_sweep(values: Sequence[xr.Dataset], dim: str, joined: xr.Dataset) -> dict[str, Any]:
    """Return the attributes of one sweep to sweeps that differ only along `dim`; else none."""
    attributes = [run.attrs for run in values]
    if not all(name in attrs for attrs in attributes for name in SWEEP_ATTRIBUTES):
        return {}
    first = attributes[0]
    alike = _EQUAL_ATTRIBUTES if dim == MOTION else (*_EQUAL_ATTRIBUTES, *MOTION_ATTRIBUTES)
    if any(attrs.get(name) != first.get(name) for attrs in attributes for name in alike):
        return {}
    axes = json_attribute(
        values[0], "axes_json", lambda axes: [axis["name"] for axis in axes], owner=_OWNER
    )
    if dim not in (MOTION, *axes) or dim not in joined.coords or not joined.indexes[dim].is_unique:
        return {}
    digests = " ".join(str(attrs["study_sha256"]) for attrs in attributes)
    common = {
        CASE_COUNT: joined["status"].size,
        "study_sha256": hashlib.sha256(f"joined along {dim}: {digests}".encode()).hexdigest(),
    }
    if dim != MOTION:
        return common
    named = [described_motions(run, owner=_OWNER) for run in values]
    motions = {name: motion for of_run in named for name, motion in of_run.items()}
    if len(motions) < sum(map(len, named)):
        return {}
    described = [list(motions), list(motions.values())]
    return common | dict(zip(MOTION_ATTRIBUTES, map(json.dumps, described), strict=True))


def described_motions(dataset: xr.Dataset, *, owner: str) -> dict[str, dict[str, Any] | None]:
    """Return the descriptions of a sweep's motions by their names; None is still ground."""

    def read(described: list[Any]) -> dict[str, dict[str, Any] | None]:
        records = [each for each in described if each and not each.get("constructor")]
        if not all({"name", "sha256"} <= set(each) for each in records):
            msg = "a record lacks its name or sha256"
            raise LookupError(msg)
        return dict(zip(names, described, strict=True))

    names = json_attribute(dataset, MOTION_ATTRIBUTES[0], list, owner=owner)
    return json_attribute(dataset, MOTION_ATTRIBUTES[1], read, owner=owner)


def _same(first: object, second: object) -> bool:
    a, b = np.asarray(first), np.asarray(second)
    return np.array_equal(a, b, equal_nan=a.dtype.kind == b.dtype.kind == "f")


def _labelled(
    joined: xr.Dataset, dim: str, labels: Sequence[Any] | np.ndarray | xr.DataArray
) -> xr.Dataset:
    if isinstance(labels, str) or not is_iterable(labels):
        msg = (
            f"{_OWNER}: labels must be a list of values, one for each run, got {short_repr(labels)}"
        )
        raise SchemaError(msg)
    listed = labels.to_numpy() if isinstance(labels, xr.DataArray) else list(labels)
    if any(attached_unit(label) for label in listed):
        example = "xr.DataArray([1, 2], attrs={'units': 'm s^-2'})"
        msg = f"{_OWNER}: labels with a unit come as {example}, got {short_repr(labels)}"
        raise SchemaError(msg)
    values = np.asarray(listed)
    if values.shape != (joined.sizes[dim],):
        found = f"{len(values)} labels" if values.ndim == 1 else f"labels of shape {values.shape}"
        msg = f"{_OWNER}: found {found} for {joined.sizes[dim]} runs along {dim!r}"
        raise SchemaError(msg)
    attributes = dict(labels.attrs) if isinstance(labels, xr.DataArray) else {}
    attributes.setdefault("long_name", dim.replace("_", " "))
    return joined.assign_coords({dim: (dim, values, attributes)})
