"""Matching all motions of a suite to a target spectrum."""

from dataclasses import replace
from typing import Any, TypeVar

from rockframe.errors import RecordWarning, collected_warnings, warn
from rockframe.motion import GroundMotion
from rockframe.motion.operations.matching import USUAL_PERIODS, Target
from rockframe.suites.labelled_motions import LabelledMotions
from rockframe.suites.target import TargetSpectrum
from rockframe.units import PERIOD, to_si_values

Suite = TypeVar("Suite", bound=LabelledMotions)


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
