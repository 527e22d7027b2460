"""Scaling motions so that their spectra fit a target, and matching their spectra to it."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Final, TypeVar

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from rockframe.errors import ComponentError, RecordWarning, SchemaError, collected_warnings, warn
from rockframe.measures.common import OSCILLATOR_REFERENCE
from rockframe.motion import GroundMotion
from rockframe.motion.operations.matching import USUAL_PERIODS, Target
from rockframe.motion.quantities import ArrayLike
from rockframe.motion.value import replaced
from rockframe.results.joining import MOTION
from rockframe.results.schema import (
    SCHEMA,
    build_dataset,
    in_units_of_schema,
    labels_in_unit,
    with_variables,
    without_fill_values,
)
from rockframe.signals.arrays import Array
from rockframe.suggestions import with_hints
from rockframe.suites.candidates import Candidates, Combination, candidates_of
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.target import TargetSpectrum
from rockframe.units import PERIOD, QuantityLike, RatioLike, Unit, to_si_values

Suite = TypeVar("Suite", bound=LabelledMotions)

DEFAULT_BOUNDS: Final = (0.25, 4.0)
"""Bounds of scale factors that are usually accepted [1]."""
_ROUNDING: Final = 1e-9
_SCALED_TO: Final = "MotionSuite.scaled_to"


@with_hints()
def scaling_to(
    suite: LabelledMotions,
    target: TargetSpectrum,
    *,
    periods: ArrayLike | Iterable[QuantityLike] | None = None,
    conditioned_on: ArrayLike | Iterable[QuantityLike] | None = None,
    bounds: tuple[RatioLike, RatioLike] | None = DEFAULT_BOUNDS,
    combination: str = Combination.EACH,
) -> xr.Dataset:
    """Find the factor that scales each motion's spectrum to a target, and the remaining misfit.

    Parameters
    ----------
    target : TargetSpectrum
        The target spectrum; its damping ratio is that of the spectra.
    periods : (sequence, unit), Quantity or sequence of str, optional
        Periods at which spectra are compared, all of equal weight. The default is 40 periods from
        0.1 s to 4 s, logarithmically spaced [s].
    conditioned_on : (sequence, unit), Quantity or sequence of str, optional
        One period, at which every scaled spectrum equals the target, or several, over which the
        average spectral acceleration equals that of the target [s].
    bounds : tuple of two float, or None
        Least and greatest factor; factors beyond are set to the bound [1].
    combination : {"each", "geometric mean", "RotD50", "RotD100"}, optional
        Whether each motion has its own factor, or both components of a record have a common factor,
        computed from this spectrum of the pair.

    Returns
    -------
    xarray.Dataset
        Over ``motion`` (records, if components are combined): ``scale_factor`` [1],
        :eq:`eq-scale-factor`; ``spectral_misfit`` [1], :eq:`eq-spectral-misfit`;
        ``scaled_spectral_acceleration`` over ``period`` too [m s^-2]. For the whole set, over
        ``period``: ``target_spectral_acceleration``, ``set_median_acceleration`` [m s^-2],
        ``target_standard_deviation``, ``set_standard_deviation`` [1].

    Raises
    ------
    UnitsError
        Periods without a unit, or with one of another kind.
    ComponentError
        The target is no TargetSpectrum or undefined at some periods, a motion has no acceleration,
        there are no pairs to combine, or an argument is out of range.

    Warns
    -----
    RecordWarning
        Some periods are shorter than ten time steps of a record.

    Examples
    --------
    >>> import rockframe as rf
    >>> suite = rf.MotionSuite([rf.GroundMotion.stochastic(6, "20 km", seed=k) for k in (1, 2)])
    >>> target = rf.TargetSpectrum.eurocode_8("0.1 g_0")
    >>> found = suite.scaling_to(target, conditioned_on=["1 s"], bounds=None)
    >>> scaled = suite.scaled_to(found)
    >>> spectrum = scaled.response_spectrum(["1 s"]).pseudo_spectral_acceleration
    >>> bool(abs(spectrum - target.at(["1 s"])[0]).max() < 1e-12)
    True
    """
    candidates = candidates_of(
        suite,
        target,
        periods=periods,
        conditioned_on=conditioned_on,
        bounds=bounds,
        combination=combination,
        owner=f"{type(suite).__name__}.scaling_to",
    )
    factors = np.clip(candidates.factors, *candidates.bounds)
    return scaled_set(
        candidates, np.arange(len(candidates.labels)), factors, title="Scaled motions"
    )


def scaled_set(
    candidates: Candidates,
    places: NDArray[np.intp],
    factors: Array,
    *,
    title: str,
    **attributes: str | float,
) -> xr.Dataset:
    """Return a labelled dataset of a set of scaled motions and its target."""
    residuals = candidates.residuals(factors)[places]
    log_spectra = residuals + candidates.log_target
    low, high = candidates.bounds
    at_bound = (factors[places] <= low * (1 + _ROUNDING)) | (
        factors[places] >= high * (1 - _ROUNDING)
    )
    of_each = build_dataset(
        {
            "scale_factor": factors[places],
            "spectral_misfit": np.sqrt((residuals**2).mean(axis=1)),
            "scaled_spectral_acceleration": np.exp(log_spectra),
        },
        {
            **candidates.attributes,
            "references": OSCILLATOR_REFERENCE,
            "least_factor": low,
            "greatest_factor": high,
            "factors_at_a_bound": int(at_bound.sum()),
            **attributes,
        },
        over=(MOTION,),
        title=title,
        source="recurrence of Nigam and Jennings",
    )
    of_all = {
        "target_spectral_acceleration": np.exp(candidates.log_target),
        "target_standard_deviation": candidates.deviations,
        "set_median_acceleration": np.exp(log_spectra.mean(axis=0)),
        "set_standard_deviation": _standard_deviation(log_spectra),
    }
    dataset = with_variables(of_each, of_all)
    labels = [candidates.labels[place] for place in places.tolist()]
    meaning = {**SCHEMA["period"].attributes(), "long_name": "undamped period of the oscillator"}
    dataset = dataset.assign_coords(
        {
            MOTION: (MOTION, labels, {"long_name": "ground motion"}),
            "period": ("period", candidates.periods, meaning),
        }
    )
    return without_fill_values(dataset)


def compared_periods(scaling: xr.Dataset) -> Array:
    """Return the periods at which scaled motions were compared with their target [s]."""
    return labels_in_unit(scaling["period"], Unit.SECOND, owner=_SCALED_TO).to_numpy()


def compared_target(scaling: xr.Dataset) -> TargetSpectrum | None:
    """Return the target of scaled motions, known at the periods that were compared."""
    periods = compared_periods(scaling)
    if periods.size < 2:
        return None
    scaling = in_units_of_schema(scaling, owner=_SCALED_TO)
    spread = scaling["target_standard_deviation"].to_numpy()
    return TargetSpectrum.from_table(
        (periods, str(Unit.SECOND)),
        (scaling["target_spectral_acceleration"].to_numpy(), str(Unit.METRE_PER_SECOND_SQUARED)),
        standard_deviations=spread.tolist() if spread.any() else None,
        damping_ratio=float(scaling.attrs["damping_ratio"]),
        name=str(scaling.attrs["target"]),
    )


def _standard_deviation(logarithms: Array) -> Array:
    """Return the standard deviation over a set, shape (k,); zero of a single motion."""
    if len(logarithms) < 2:
        return np.zeros(logarithms.shape[1])
    return logarithms.std(axis=0, ddof=1)


def scaled_motions(
    suite: LabelledMotions, scaling: xr.Dataset
) -> tuple[dict[str, GroundMotion], dict[str, GroundMotion]]:
    """Scale the motions of a suite by the factors that were found."""
    needed = ("scale_factor", "spectral_misfit", MOTION)
    if any(name not in scaling.variables for name in needed) or "combination" not in scaling.attrs:
        msg = (
            f"{_SCALED_TO}: expected a TargetSpectrum, or a dataset of scaling_to or selection_for"
        )
        raise SchemaError(msg)
    scaling = in_units_of_schema(scaling, owner=_SCALED_TO)
    one_by_one = scaling.attrs["combination"] == Combination.EACH
    motions: dict[str, GroundMotion] = {}
    verticals: dict[str, GroundMotion] = {}
    for place, value in enumerate(scaling[MOTION].to_numpy()):
        label = str(value)
        factor = float(scaling["scale_factor"][place])
        misfit = float(scaling["spectral_misfit"][place])
        before = len(motions)
        for name, motion in suite.items():
            if (name if one_by_one else motion.metadata.get("record")) == label:
                motions[name] = _scaled(motion, factor, misfit)
        if len(motions) == before:
            msg = f"{_SCALED_TO}: the suite has no {label!r}"
            raise ComponentError(msg)
        for name, motion in suite.verticals.items():
            if not one_by_one and motion.metadata.get("record") == label:
                verticals[name] = _scaled(motion, factor, misfit)
    return motions, verticals


def _scaled(motion: GroundMotion, factor: float, misfit: float) -> GroundMotion:
    scaled = motion.scaled(factor)
    return replaced(scaled, metadata={**scaled.metadata, "spectral_misfit": misfit})


def matched(suite: Suite, target: Target, **arguments: Any) -> Suite:
    """Match the spectrum of each motion to a target, by wavelets added in time.

    Parameters
    ----------
    target : TargetSpectrum
        The target spectrum.
    **arguments
        As for :meth:`GroundMotion.matched`: `periods` [s], `tolerance` [1].

    Returns
    -------
    MotionSuite
        Without vertical components, unless :meth:`with_verticals` has added them to their motions;
        these are not changed. `table` has ``largest_spectral_misfit``, ``mean_spectral_misfit``,
        ``spectral_misfit`` and ``scale_factor`` [1] of each motion, and other changes: its peaks
        and pulse indicator before and after, and the growth of the spectrum beyond the range.

    Raises
    ------
    UnitsError, ComponentError
        As for :meth:`GroundMotion.matched`.

    Warns
    -----
    RecordWarning
        As :meth:`GroundMotion.matched`, once for all motions together.

    Examples
    --------
    >>> import rockframe as rf
    >>> record = rf.GroundMotion.example("loma-prieta").window("5 s", "12 s")
    >>> target = rf.TargetSpectrum.eurocode_8("0.1 g_0", "B")
    >>> found = rf.MotionSuite({"A": record}).matched(target, periods=("0.2 s", "0.5 s"))
    >>> found["A"].metadata["largest_spectral_misfit"] <= 0.05
    True
    """
    motions: dict[str, GroundMotion] = {}
    messages: list[str] = []
    for label, motion in suite.items():
        with collected_warnings() as texts:
            motions[label] = motion.matched(target, **arguments)
        messages += [f"{label!r}: {text}" for text in texts]
    owner = f"{type(suite).__name__}.matched"
    if messages:
        msg = f"{owner}: of {len(motions)} motions\n" + "\n".join(messages)
        warn(msg, RecordWarning)
    compared = None
    if isinstance(target, TargetSpectrum):
        ends = to_si_values(arguments.get("periods", USUAL_PERIODS), PERIOD, owner=owner, name="")
        compared = replace(target, limits=(ends[0], ends[1]))
    return type(suite)(motions, unread=suite.unread, remarks=suite.remarks, target=compared)
