"""Constructor of synthetic motions from the stochastic point-source model."""

from __future__ import annotations

from functools import partial
from typing import Final

from rockframe.arguments import checked_choice, checked_integer
from rockframe.errors import ComponentError, ModelWarning, warn
from rockframe.motion.stochastic import LARGEST_DISTANCE, Corners, PointSource, Site, accelerogram
from rockframe.motion.value import MotionType
from rockframe.signals import Motion
from rockframe.suggestions import with_hints
from rockframe.units import (
    DENSITY,
    NOT_NEGATIVE,
    POSITIVE,
    TIME,
    Condition,
    Measure,
    QuantityLike,
    RatioLike,
    Unit,
    to_ratio,
    to_si,
)

MODEL: Final = (
    "stochastic point source: Boore (2003), doi:10.1007/PL00012553, with the parameters of "
    "Boore and Thompson (2015), doi:10.1785/0120140281"
)
"""Source of the model, for the metadata."""

LARGEST_MAGNITUDE: Final = 8.0
"""Magnitude up to which the saturation length is calibrated [1] (Yenier and Atkinson 2015)."""

LONGEST_DURATION: Final = 1_000.0
"""Longest plausible duration [s]."""

TWO_CORNERS_FROM: Final = 6.0
"""Magnitude from which on a source has two corner frequencies by default [1]. Above it, spectra of
one corner are 1.2 to 2.2 times those of recorded motions at 1 s to 5 s, those of two 0.7 to 1.5
times."""

_DISTANCE: Final = Measure("a distance", Unit.METRE, "15 km")
_STRESS: Final = Measure("a stress", Unit.PASCAL, "10 MPa")
_WAVES: Final = Measure("a velocity", Unit.METRE_PER_SECOND, "3.5 km/s")
_KAPPA: Final = TIME.like("0.035 s")
_STEP: Final = TIME.like("0.005 s")

_MAGNITUDES: Final = Condition(
    "from 3 to 8.5, the range of the model", lambda value: 3.0 <= value <= 8.5
)
_DISTANCES: Final = Condition("above 0 and at most 1000 km", lambda value: 0.0 < value <= 1e6)
_STEPS: Final = Condition("from 0.0005 s to 0.02 s", lambda value: 0.0005 <= value <= 0.02)
_EXPONENTS: Final = Condition("from 0 to 1", lambda value: 0.0 <= value <= 1.0)


@with_hints()
def stochastic(
    kind: type[MotionType],
    magnitude: RatioLike,
    distance: QuantityLike,
    seed: int,
    *,
    stress_drop: QuantityLike = "10 MPa",
    shear_wave_velocity: QuantityLike = "3.5 km/s",
    density: QuantityLike = "2720 kg/m^3",
    quality_factor: RatioLike = 180,
    quality_exponent: RatioLike = 0.45,
    kappa: QuantityLike = "0.035 s",
    site: Site | str = "rock 760",
    source: Corners | str | None = None,
    vertical: RatioLike | None = None,
    time_step: QuantityLike = "0.005 s",
) -> MotionType:
    """Generate a random motion of an earthquake from a published model.

    Windowed noise is given the mean spectrum of an earthquake of this magnitude at this
    distance, :eq:`eq-target-spectrum`: that of the point source of Boore (2003) with the
    parameters of Boore and Thompson (2015) for active crustal regions. Another seed gives
    another motion of the same earthquake.

    Parameters
    ----------
    magnitude : float
        Moment magnitude [1].
    distance : str or Quantity
        Closest distance to the rupture; for a small earthquake, to the hypocentre [m].
    seed : int
        Seed of the random numbers, zero or more; the same seed gives the same motion.
    stress_drop : str or Quantity, optional
        Stress drop; 10 MPa are 100 bar [Pa].
    shear_wave_velocity : str or Quantity, optional
        Shear-wave velocity of the crust at the source [m s^-1].
    density : str or Quantity, optional
        Density of the crust at the source [kg m^-3].
    quality_factor : float, optional
        Q0 of the crust, at 1 Hz [1].
    quality_exponent : float, optional
        n of Q(f) = Q0 (f/Hz)^n [1].
    kappa : str or Quantity, optional
        Loss of high frequencies at the site, exp(-pi kappa f) [s].
    site : Site or str, optional
        ``"rock 760"`` or ``"rock 620"``: mean shear-wave velocity of the upper
        30 m in m/s.
    source : Corners or str, optional
        ``"one corner"``, the default below magnitude 6: the spectrum of a point source, which for
        larger magnitudes is too strong at periods of 1 s to 5 s. ``"two corners"``, the default
        from magnitude 6 on: the spectrum of a large fault, which corrects most of this (Atkinson
        and Silva 2000, Boore et al. 2014).
    vertical : float, optional
        Ratio of vertical to horizontal spectrum, the same at all frequencies; by default there is
        no vertical component [1].
    time_step : str or Quantity, optional
        Time between samples [s].

    Returns
    -------
    GroundMotion
        One horizontal component, from rest to rest.

    Raises
    ------
    UnitsError
        A wrong unit, or none.
    ComponentError
        A magnitude, distance or time step outside its range, a seed that is not a whole number,
        an unknown site or source, a value that is not positive, or implausible values.

    Warns
    -----
    ModelWarning
        The magnitude exceeds 8, or the distance 270 km: the model is extrapolated.

    Notes
    -----
    At first the ground is nearly still: the motion rises from rest for about 1/f_c, and is below
    1 % of its peak for about a quarter of its length, such as 11 s of 45 s at magnitude 6.5 and
    15 km. ``window`` can leave this part out, but the rest no longer starts at rest, which distorts
    the displacement of the ground.

    Examples
    --------
    >>> from rockframe import GroundMotion
    >>> motion = GroundMotion.stochastic(6.5, "15 km", seed=1)
    >>> motion.metadata["seed"]
    1
    """
    owner = f"{kind.__name__}.stochastic"
    number, amount = partial(to_ratio, owner=owner), partial(to_si, owner=owner)
    size = number(magnitude, name="magnitude", condition=_MAGNITUDES, example="6.5")
    usual = Corners.TWO if size >= TWO_CORNERS_FROM else Corners.ONE
    earthquake = PointSource(
        magnitude=size,
        distance=amount(distance, _DISTANCE, name="distance", condition=_DISTANCES),
        stress_drop=amount(stress_drop, _STRESS, name="stress_drop", condition=POSITIVE),
        shear_wave_velocity=amount(
            shear_wave_velocity, _WAVES, name="shear_wave_velocity", condition=POSITIVE
        ),
        density=amount(density, DENSITY, name="density", condition=POSITIVE),
        quality_factor=number(
            quality_factor, name="quality_factor", condition=POSITIVE, example="180"
        ),
        quality_exponent=number(quality_exponent, name="quality_exponent", condition=_EXPONENTS),
        kappa=amount(kappa, _KAPPA, name="kappa", condition=NOT_NEGATIVE),
        site=checked_choice(Site, site, owner=owner, name="site"),
        corners=usual
        if source is None
        else checked_choice(Corners, source, owner=owner, name="source"),
    )
    first = checked_integer(seed, owner=owner, name="seed", lowest=0)
    ratio = None if vertical is None else number(vertical, name="vertical", condition=POSITIVE)
    step = amount(time_step, _STEP, name="time_step", condition=_STEPS)
    for message in _extrapolations(earthquake, owner):
        warn(message, ModelWarning)
    across = accelerogram(earthquake, step, first)
    upwards = None if ratio is None else ratio * accelerogram(earthquake, step, first, stream=1)
    arguments = _arguments(earthquake, first, ratio, step)
    what = f"magnitude {earthquake.magnitude:.6g} at {earthquake.distance / 1e3:.6g} km"
    return kind(
        Motion.of_samples(step, across, upwards),
        name=f"stochastic motion, {what}, {earthquake.site}, seed {first}",
        metadata={"model": MODEL, **arguments},
        history=(
            "drawn from a stochastic point source: "
            + ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in arguments.items()),
        ),
        recipe={"constructor": "stochastic", **arguments},
    )


def _extrapolations(source: PointSource, owner: str) -> list[str]:
    """Warn of values beyond the calibration of the model; refuse implausible ones."""
    try:
        duration = source.duration
    except ArithmeticError as problem:
        msg = (
            f"{owner}: source = {str(source.corners)!r} has {problem}; stress_drop or "
            "shear_wave_velocity is too low for it; take 'one corner'"
        )
        raise ComponentError(msg) from problem
    if duration > LONGEST_DURATION:
        msg = (
            f"{owner}: an earthquake of these properties would last {duration:.6g} s; "
            f"stress_drop, shear_wave_velocity or magnitude is implausible"
        )
        raise ComponentError(msg)
    warnings: list[str] = []
    if source.magnitude > LARGEST_MAGNITUDE:
        warnings.append(
            f"{owner}: magnitude = {source.magnitude:.6g} is beyond {LARGEST_MAGNITUDE:g}, up to "
            "which the saturation of the model near large faults is calibrated"
        )
    if source.distance > LARGEST_DISTANCE:
        warnings.append(
            f"{owner}: distance = {source.distance / 1e3:.6g} km is beyond "
            f"{LARGEST_DISTANCE / 1e3:g} km, where the table of path durations ends"
        )
    return warnings


def _arguments(
    source: PointSource, seed: int, vertical: float | None, time_step: float
) -> dict[str, str | float | int]:
    """Return all arguments, so that the motion can be built again after changes of defaults."""
    return {
        "magnitude": source.magnitude,
        "distance": f"{source.distance!r} {_DISTANCE.unit}",
        "seed": seed,
        "stress_drop": f"{source.stress_drop!r} {_STRESS.unit}",
        "shear_wave_velocity": f"{source.shear_wave_velocity!r} {_WAVES.unit}",
        "density": f"{source.density!r} {DENSITY.unit}",
        "quality_factor": source.quality_factor,
        "quality_exponent": source.quality_exponent,
        "kappa": f"{source.kappa!r} {_KAPPA.unit}",
        "site": str(source.site),
        "source": str(source.corners),
        **({} if vertical is None else {"vertical": vertical}),
        "time_step": f"{time_step!r} {_STEP.unit}",
    }
