"""A ground motion in plain values, and back: the constructor, and what was done since."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from rockframe.errors import SchemaError, shown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rockframe.motion.value import Made, MotionValue

ANALYTIC: Final = (
    "sine_pulse",
    "cosine_pulse",
    "half_sine_pulse",
    "harmonic",
    "type_a_pulse",
    "type_b_pulse",
    "type_c_pulse",
    "ricker_wavelet",
    "mavroeidis_papageorgiou_pulse",
    "double_impulse",
)
"""Constructors of pulses."""

CONSTRUCTORS: Final = (*ANALYTIC, "stochastic")
"""Constructors that a recipe may name."""

OPERATIONS: Final = (
    "window",
    "scaled",
    "resampled",
    "filtered",
    "baseline_corrected",
    "with_vertical",
    "rotated",
)
"""Operations that a recipe may name."""


def to_dict(motion: MotionValue) -> dict[str, Any]:
    """Describe the motion: an analytic one completely, a record by its digest.

    Returns
    -------
    dict
        Plain values, fit for JSON: constructor and arguments of an analytic motion,
        with the ``operations`` done to it since; ``constructor`` is None for a
        motion that only its samples describe.
    """
    kind = {"type": type(motion).__name__}
    if motion.recipe is not None:
        return {**kind, **motion.recipe}
    return {**kind, "constructor": None, "name": motion.name, "sha256": motion.sha256}


def from_dict(kind: type[Made], description: Mapping[str, Any]) -> Made:
    """Build the analytic motion that :meth:`to_dict` described.

    Parameters
    ----------
    description : mapping
        As written by :meth:`to_dict`.

    Returns
    -------
    GroundMotion

    Raises
    ------
    SchemaError
        The motion is a record, which must be supplied, or the description
        fits no constructor.
    """
    arguments = {key: value for key, value in description.items() if key != "type"}
    constructor = arguments.pop("constructor", None)
    operations = arguments.pop("operations", ())
    if constructor is None:
        known = " and ".join(
            f"{key} {arguments[key]}" for key in ("name", "sha256") if key in arguments
        )
        msg = f"found only {known or 'a description'} of a record; supply the record itself"
        raise SchemaError(msg)
    if constructor not in CONSTRUCTORS:
        known = ", ".join(CONSTRUCTORS)
        msg = f"found the constructor {shown(constructor)}; expected one of {known}"
        raise SchemaError(msg)
    try:
        motion = getattr(kind, constructor)(**arguments)
        for operation in operations:
            ((name, given),) = operation.items()
            if name not in OPERATIONS:
                known = ", ".join(OPERATIONS)
                msg = f"found the operation {shown(name)}; expected one of {known}"
                raise SchemaError(msg)
            if "other" in given:
                given = {**given, "other": from_dict(kind, given["other"])}
            motion = getattr(motion, name)(**given)
    except TypeError as problem:
        msg = f"found arguments that do not fit {constructor} or what was done to it: {problem}"
        raise SchemaError(msg) from problem
    return motion
