"""A certificate in one or two sentences."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from rockframe.simulation.beside import Beside
from rockframe.simulation.certification import Certificate, Certification
from rockframe.simulation.finer import SHORTER, tolerance_words
from rockframe.simulation.nudging import share
from rockframe.simulation.plan import Plan
from rockframe.simulation.scan import Scan

NEAR: Final = 0.01
"""A margin up to which a verdict is called near the boundary [1]."""

Named = Sequence[tuple[str, Beside]]
Scans = Sequence[tuple[str, Scan]]


def sentence(
    certificate: Certificate,
    base: Beside,
    finer: Named,
    nudged: Scans,
    along: Scan,
    wanted: Certification,
    plan: Plan,
) -> str:
    """Say what was tried and what was found.

    Parameters
    ----------
    certificate : Certificate
        What came of it.
    base : Beside
        The run.
    finer : sequence of (str, Beside)
        Runs by finer means.
    nudged : sequence of (str, Scan)
        Runs with a parameter changed.
    along : Scan
        Runs with a scaled motion or start.
    wanted : Certification
        What was to be tried.
    plan : Plan
        The run's arguments.

    Returns
    -------
    str
    """
    verdict = _ends(base)[3:]
    doubts = [
        *_unsettled(certificate, base, finer),
        *_fragile(nudged, base),
        *_near(certificate, along, wanted, plan),
    ]
    if doubts:
        return f"Near the boundary: the body {verdict}, but {'; '.join(doubts)}."
    means = [tolerance_words(plan.accuracy), f"steps {SHORTER:g} times shorter"]
    if plan.motion is not None:
        means.append("the motion cut finer")
    text = (
        f"The body {verdict} also with {', '.join(means[:-1])} and {means[-1]}, and with every "
        f"parameter up to {100.0 * wanted.nudge:g} % larger or smaller"
    )
    return f"{text}.{_range(certificate, along, wanted, plan)}"


def _unsettled(certificate: Certificate, base: Beside, finer: Named) -> Iterator[str]:
    """Say which runs by finer means end otherwise, or come too near to it."""
    if certificate.converged:
        return
    others = [(words, other) for words, other in finer if other.overturned != base.overturned]
    if others:
        words, other = others[0]
        yield f"with {words}{_more(others)} {_ends(other)}"
    elif base.overturned:
        yield "runs by finer means overturn otherwise, or only just"
    else:
        yield (
            f"its peak rotation is uncertain by {certificate.peak_error:.2g} rad, about what is "
            "left to overturning"
        )


def _fragile(nudged: Scans, base: Beside) -> Iterator[str]:
    """Say which parameters change the verdict."""
    changed = [(words, found) for words, found in nudged if found.flip is not None]
    if changed:
        words, found = changed[0]
        flip, ended = found.flip or 0.0, found.ended or base
        yield f"with the {words} {100.0 * flip:+.3g} %{_more(changed)} {_ends(ended)}"
        return
    lost = [words for words, found in nudged if not found.followed]
    if lost:
        yield f"it depends on the {lost[0]}{_more(lost)} in too intricate a way to be followed"


def _near(
    certificate: Certificate, along: Scan, wanted: Certification, plan: Plan
) -> Iterator[str]:
    """Say that a slightly other scale changes the verdict, or may."""
    if math.isnan(certificate.margin) or certificate.margin > max(NEAR, wanted.nudge):
        return
    what = _driver(plan)
    if along.flip is not None and along.ended is not None and abs(along.flip) <= 2.0 * NEAR:
        way = "up" if along.flip > 0.0 else "down"
        yield f"with {what} scaled {way} by {share(abs(along.flip))} {_ends(along.ended)}"
    elif not along.followed:
        yield (
            f"it depends on the scale of {what} in too intricate a way to be followed farther "
            f"than {share(certificate.margin)}"
        )


def _range(certificate: Certificate, along: Scan, wanted: Certification, plan: Plan) -> str:
    """Say at which scales no other verdict was found."""
    if math.isnan(certificate.margin):
        return ""
    margin, what = certificate.margin, _driver(plan)
    low, high = (f"{1.0 + sign * margin:.6g}" for sign in (-1.0, 1.0))
    text = (
        f" No other verdict was found at the {along.within(margin)} scales of {what} tried from "
        f"{low} to {high}"
    )
    if not along.followed:
        return f"{text}; {wanted.runs} runs did not do to follow it farther."
    if along.flip is not None:
        return f"{text}; the nearest one with another verdict is {certificate.flip:.6g}."
    return f"{text}."


def _more(all_of: Sequence[object]) -> str:
    return f" (and {len(all_of) - 1} more)" if len(all_of) > 1 else ""


def _ends(shown: Beside) -> str:
    if shown.overturned is None:
        return "the run cannot be finished"
    return "it overturns" if shown.overturned else "it stands"


def _driver(plan: Plan) -> str:
    return "the motion" if plan.motion is not None else "the start"
