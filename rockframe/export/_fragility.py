"""Results for other programs: fragilities for pelicun's library and OpenQuake's files."""

import math
import re
import xml.etree.ElementTree as Tree
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Final, cast

import pandas as pd
import xarray as xr

from rockframe.arguments import (
    checked_bool,
    checked_dataset,
    checked_integer,
    checked_mapping,
    checked_name,
    checked_text,
)
from rockframe.constants import STANDARD_GRAVITY
from rockframe.errors import ComponentError, SchemaError, first_along, short_repr
from rockframe.results.variables.analyses import LIMIT_STATE, FragilityStatus
from rockframe.studies.fragility.words import in_own_units
from rockframe.studies.intensities import MEASURE_ABBREVIATIONS, PERIOD_ATTRIBUTE
from rockframe.suggestions import with_hints
from rockframe.units import POSITIVE, to_ratio
from rockframe.version import __version__
from rockframe.writing import FileKind, write_file

_PELICUN: Final = "to_pelicun"
_OPENQUAKE: Final = "to_openquake"
_NAMESPACE: Final = "http://openquake.org/xmlns/nrml/0.5"
_PROLOGUE: Final = "<?xml version='1.0' encoding='UTF-8'?>\n"
_SIGNATURE: Final = "fragility model by rockframe "
_FILE_KIND: Final = FileKind.marked("a fragility model", (".xml",), _SIGNATURE)
_LOSS_CATEGORIES: Final = ("structural", "nonstructural", "contents", "business_interruption")
_IDENTIFIER: Final = re.compile(r"[A-Za-z0-9_-]{1,100}")

_MAX_STOREYS: Final = 1000
_PELICUN_MEASURES: Final = {
    # (demand type, unit, SI units in it)
    MEASURE_ABBREVIATIONS["PGA"]: ("Peak Ground Acceleration", "g", STANDARD_GRAVITY),
    MEASURE_ABBREVIATIONS["PGV"]: ("Peak Ground Velocity", "mps", 1.0),
    MEASURE_ABBREVIATIONS["SA"]: ("Peak Spectral Acceleration", "g", STANDARD_GRAVITY),
}
_DEMAND_QUANTITIES: Final = frozenset(
    {"spectral", "acceleration", "velocity", "displacement", "drift"}
)
"""Words that identify the quantity in the type of a demand."""
_OPENQUAKE_MEASURES: Final = {
    # (intensity measure type, SI units in its unit)
    MEASURE_ABBREVIATIONS["PGA"]: ("PGA", STANDARD_GRAVITY),
    MEASURE_ABBREVIATIONS["PGV"]: ("PGV", 0.01),
    MEASURE_ABBREVIATIONS["SA"]: ("SA", STANDARD_GRAVITY),
}


@with_hints()
def to_pelicun(
    fragility: xr.Dataset,
    component: str,
    *,
    demand: str | None = None,
    offset: int = 0,
    directional: bool = True,
) -> pd.DataFrame:
    """Return the row of a component in pelicun's library of damage models.

    Parameters
    ----------
    fragility : xarray.Dataset
        Result of :func:`rockframe.fragility`, over the peak ground acceleration or velocity, or a
        spectral acceleration.
    component : str
        Identifier of the component, such as ``"E.20.22.106a"``.
    demand : str, optional
        Type of the demand, such as ``"Peak Floor Velocity"`` for motions of a floor. The default is
        that of the ground.
    offset : int, optional
        Storeys between the component's location and its demand.
    directional : bool, optional
        Whether the demand has a direction, like that of a planar block. Otherwise pelicun takes 1.2
        times the larger demand of two directions.

    Returns
    -------
    pandas.DataFrame
        A row named after the component, with medians in g or m/s; its ``to_csv`` writes the file
        for pelicun.

    Raises
    ------
    SchemaError
        The dataset is not a fragility over one such measure.
    ComponentError
        A limit state has no fit, or dispersion zero; there are several structures; or the
        demand is of another quantity than the fragility.

    Notes
    -----
    The format is that of pelicun 3: limit states in columns ``LS1-Family``, ``LS1-Theta_0``
    (median) and ``LS1-Theta_1`` (dispersion), and so on, from the least median up.

    Examples
    --------
    >>> import rockframe as rf
    >>> counts = {"intensity": ([0.2, 0.4, 0.8], "m/s"), "exceeded": [1, 6, 19], "trials": 20}
    >>> found = rf.fragility(counts, "PGV")
    >>> row = rf.export.to_pelicun(found, "bookcase", demand="Peak Floor Velocity")
    >>> row["Demand-Unit"].item(), round(row["LS1-Theta_0"].item(), 2)
    ('mps', 0.45)
    """
    import pandas as pd

    identifier = checked_text(component, owner=_PELICUN, name="component")
    storeys = checked_integer(offset, owner=_PELICUN, name="offset", lowest=-_MAX_STOREYS)
    checked_bool(directional, owner=_PELICUN, name="directional")
    measure, states = _fitted_limit_states(fragility, _PELICUN_MEASURES, owner=_PELICUN)
    kind, unit, size = _PELICUN_MEASURES[measure]
    if demand is not None:
        _check_demand(checked_text(demand, owner=_PELICUN, name="demand"), measure, kind)
    if measure == MEASURE_ABBREVIATIONS["SA"]:
        kind = f"{kind}|{_period(fragility, _PELICUN):g}"
    row: dict[str, Any] = {
        "Incomplete": 0,
        "Demand-Type": kind if demand is None else demand,
        "Demand-Unit": unit,
        "Demand-Offset": storeys,
        "Demand-Directional": int(directional),
    }
    for number, (_, median, dispersion) in enumerate(states, start=1):
        row |= {
            f"LS{number}-Family": "lognormal",
            f"LS{number}-Theta_0": median / size,
            f"LS{number}-Theta_1": dispersion,
            f"LS{number}-DamageStateWeights": None,
        }
    return pd.DataFrame([row], index=pd.Index([identifier], name="ID"))


def _check_demand(demand: str, measure: str, kind: str) -> None:
    """Raise on a demand whose words name another quantity than that of the fragility."""
    stated, needed = (
        _DEMAND_QUANTITIES.intersection(re.findall("[a-z]+", of.lower())) for of in (demand, kind)
    )
    if stated and stated != needed:
        msg = (
            f"{_PELICUN}: the demand must be of the measure of the fragility, {measure}, as "
            f"{kind!r} is, got {demand!r}; fit a fragility over the measure of the demand"
        )
        raise ComponentError(msg)


@with_hints()
def to_openquake(
    fragilities: Mapping[str, xr.Dataset],
    path: str | PathLike[str],
    *,
    name: str = "rockframe",
    description: str = "Rocking blocks, computed by rockframe",
    loss: str = "contents",
    category: str = "contents",
    no_damage_limit: float | None = None,
    overwrite: bool = False,
) -> Path:
    """Write OpenQuake's fragility model, NRML 0.5.

    Parameters
    ----------
    fragilities : mapping of str to xarray.Dataset
        Results of :func:`rockframe.fragility`, by the taxonomy of their assets; all with the same
        limit states, over the peak ground acceleration or velocity, or a spectral acceleration.
    path : str or path
        The file; its name ends in ``.xml``. A file that this function wrote is replaced.
    name, description : str, optional
        Name and description of the model.
    loss : {"contents", "structural", "nonstructural", "business_interruption"}
        Category of the losses.
    category : str, optional
        Category of the assets.
    no_damage_limit : float, optional
        Intensity up to which no limit state is exceeded, in g or cm/s. The default is the least
        intensity of the fragility.
    overwrite : bool, optional
        Whether to replace an existing file that this function did not write.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    SchemaError
        The datasets are not fragilities over one such measure.
    ComponentError
        A limit state has no fit, or dispersion zero; limit states, or the order of their medians,
        differ; or a name has characters that OpenQuake does not allow.
    FileError
        The file cannot be written, its name has another ending, or it exists and this function
        did not write it.

    Notes
    -----
    OpenQuake uses the mean and the standard deviation of the capacity itself, not of its logarithm.
    With median theta and dispersion beta the mean is theta exp(beta^2/2), and the standard
    deviation is the mean times sqrt(exp(beta^2) - 1). OpenQuake replaces intensities above the
    greatest one of the fragility by that one.

    Examples
    --------
    >>> import tempfile
    >>> import rockframe as rf
    >>> counts = {"intensity": ([0.2, 0.4, 0.8], "m/s"), "exceeded": [1, 6, 19], "trials": 20}
    >>> found = rf.fragility(counts, "PGV")
    >>> rf.export.to_openquake({"bookcase": found}, f"{tempfile.mkdtemp()}/model.xml").name
    'model.xml'
    """
    checked_name(loss, _LOSS_CATEGORIES, owner=_OPENQUAKE, name="loss")
    for argument, label in (("description", description), ("category", category)):
        checked_text(label, owner=_OPENQUAKE, name=argument)
    no_damage = None if no_damage_limit is None else to_ratio(
        no_damage_limit, owner=_OPENQUAKE, name="no_damage_limit", condition=POSITIVE
    )  # fmt: skip
    fragilities = checked_mapping(
        fragilities, owner=_OPENQUAKE, name="fragilities", example="{'bookcase': fragility}"
    )
    if not fragilities:
        msg = f"{_OPENQUAKE}: found no fragilities; expected one at least"
        raise ComponentError(msg)
    for word in cast("tuple[object, ...]", (name, *fragilities)):
        if not isinstance(word, str) or not _IDENTIFIER.fullmatch(word):
            msg = (
                f"{_OPENQUAKE}: names have up to 100 letters, digits, '-' and '_', got "
                f"{short_repr(word)}"
            )
            raise ComponentError(msg)
    fitted = {
        taxonomy: _fitted_limit_states(fragility, _OPENQUAKE_MEASURES, owner=_OPENQUAKE)
        for taxonomy, fragility in fragilities.items()
    }
    names = {tuple(state for state, _, _ in states) for _, states in fitted.values()}
    if len(names) > 1:
        msg = (
            f"{_OPENQUAKE}: the fragilities must have the same limit states, in the same order of "
            f"their medians, got {sorted(names)}"
        )
        raise ComponentError(msg)
    root = Tree.Element("nrml", xmlns=_NAMESPACE)
    model = Tree.SubElement(
        root, "fragilityModel", id=name, assetCategory=category, lossCategory=loss
    )
    Tree.SubElement(model, "description").text = description
    Tree.SubElement(model, "limitStates").text = " ".join(map(_state_name, next(iter(names))))
    for taxonomy, (measure, states) in fitted.items():
        kind, size = _OPENQUAKE_MEASURES[measure]
        if measure == MEASURE_ABBREVIATIONS["SA"]:
            kind = f"SA({_period(fragilities[taxonomy], _OPENQUAKE):g})"
        function = Tree.SubElement(
            model, "fragilityFunction", id=taxonomy, format="continuous", shape="logncdf"
        )
        levels = in_own_units(fragilities[taxonomy], measure, owner=_OPENQUAKE)[measure] / size
        levels = levels.to_numpy()
        limit = float(levels[0]) if no_damage is None else no_damage
        # intensities below minIML count as minIML, so the limit must be above it
        least = min(float(levels[0]), 0.5 * limit)
        range_of = {"minIML": least, "maxIML": levels[-1], "noDamageLimit": limit}
        numbers = {name: f"{value:.10g}" for name, value in range_of.items()}
        Tree.SubElement(function, "imls", {"imt": kind, **numbers})
        for state, median, dispersion in states:
            mean = median / size * math.exp(0.5 * dispersion**2)
            deviation = mean * math.sqrt(math.expm1(dispersion**2))
            Tree.SubElement(
                function,
                "params",
                ls=_state_name(state),
                mean=f"{mean:.10g}",
                stddev=f"{deviation:.10g}",
            )
    Tree.indent(root)
    model_xml = Tree.tostring(root, encoding="unicode")
    document = f"{_PROLOGUE}<!-- {_SIGNATURE}{__version__} -->\n{model_xml}\n"
    return write_file(path, _FILE_KIND, document, overwrite=overwrite)


def _fitted_limit_states(
    value: object, measures: Mapping[str, Any], *, owner: str
) -> tuple[str, list[tuple[str, float, float]]]:
    """Return measure, and name, median and dispersion of limit states from the least median up."""
    dataset = checked_dataset(value, owner=owner)
    axes = [name for name in measures if name in dataset.dims]
    if "median_intensity" not in dataset or len(axes) != 1:
        msg = (
            f"{owner}: found no fragility over one of {', '.join(measures)}; expected that of "
            "rf.fragility"
        )
        raise SchemaError(msg)
    dataset = in_own_units(dataset, axes[0], owner=owner)
    with_states = dataset if LIMIT_STATE[0] in dataset.dims else dataset.expand_dims(*LIMIT_STATE)
    structures = [
        str(dim) for dim in with_states["fragility_status"].dims if dim not in LIMIT_STATE
    ]
    several_dims = [dim for dim in structures if with_states.sizes[dim] > 1]
    if several_dims:
        msg = (
            f"{owner}: found fragilities of several structures, by {', '.join(several_dims)}; pick "
            f"one, for example {first_along('fragility', several_dims[0])}"
        )
        raise ComponentError(msg)
    with_states = with_states.isel(dict.fromkeys(structures, 0))
    states: list[tuple[str, float, float]] = []
    for number in range(with_states.sizes["limit_state"]):
        state = with_states.isel(limit_state=number)
        name = str(state["limit_state"].item()) if "limit_state" in state.coords else "counted"
        if int(state["fragility_status"]) != FragilityStatus.FITTED:
            msg = (
                f"{owner}: limit state {name!r} has no lognormal fit (fragility_status); pick "
                "others, for example fragility.sel(limit_state=['overturning'])"
            )
            raise ComponentError(msg)
        states.append((name, float(state["median_intensity"]), float(state["dispersion"])))
    # both programs take the last limit state that is exceeded for the most severe one
    return axes[0], sorted(states, key=lambda state: state[1])


def _period(dataset: xr.Dataset, owner: str) -> float:
    if PERIOD_ATTRIBUTE not in dataset.attrs:
        msg = f"{owner}: found a spectral measure without the attribute {PERIOD_ATTRIBUTE!r}"
        raise SchemaError(msg)
    return float(dataset.attrs[PERIOD_ATTRIBUTE])


def _state_name(state: str) -> str:
    """Return the name of a limit state with characters that are not allowed replaced by ``_``."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", state)
