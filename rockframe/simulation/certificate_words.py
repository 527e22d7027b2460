"""A certificate in one or two sentences."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from rockframe.simulation.beside import Beside
from rockframe.simulation.finer import SHORTER, tolerance_words
from rockframe.simulation.plan import Plan

if TYPE_CHECKING:
    from rockframe.simulation.certificate import Certificate

NEAR: Final = 0.01
"""A margin up to which a verdict is called near the boundary [1]."""


def sentence(found: "Certificate") -> str:
    """Say what was tried and what was found.

    Parameters
    ----------
    found : Certificate
        What came of it.

    Returns
    -------
    str
    """
    if not found.finished:
        return "No certificate: the run was not finished."
    verdict = _ends(found.base)[3:]
    doubts = [*_unsettled(found), *_fragile(found), *_near(found)]
    if doubts:
        return f"Near the boundary: the body {verdict}, but {'; '.join(doubts)}."
    means = [tolerance_words(found.plan.accuracy), f"steps {SHORTER:g} times shorter"]
    if found.plan.motion is not None:
        means.append("the motion cut finer")
    body = "The body"
    if found.base.in_motion:
        body = "To the end of the run, where it can still overturn, the body"
    text = (
        f"{body} {verdict} also with {', '.join(means[:-1])} and {means[-1]}, and with every "
        f"parameter up to {100.0 * found.wanted.nudge:g} % larger or smaller"
    )
    return f"{text}.{_range(found)}"


def _unsettled(found: "Certificate") -> Iterator[str]:
    """Say which runs by finer means end otherwise, or come too near to it."""
    if found.converged:
        return
    verdict = found.base.overturned
    others = [(words, other) for words, other in found.finer if other.overturned != verdict]
    if others:
        words, other = others[0]
        yield f"with {words}{_more(others)} {_ends(other)}"
    elif verdict:
        yield "runs by finer means overturn otherwise, or only just"
    else:
        yield (
            f"its peak rotation is uncertain by {found.peak_error:.2g} rad, about what is "
            "left to overturning"
        )


def _fragile(found: "Certificate") -> Iterator[str]:
    """Say which parameters change the verdict."""
    changed = [(words, scan) for words, scan in found.nudged if scan.flip is not None]
    if changed:
        words, scan = changed[0]
        flip, ended = scan.flip or 0.0, scan.ended or found.base
        yield f"with the {words} {100.0 * flip:+.3g} %{_more(changed)} {_ends(ended)}"
        return
    lost = [words for words, scan in found.nudged if not scan.followed]
    if lost:
        yield f"it depends on the {lost[0]}{_more(lost)} in too intricate a way to be followed"


def _near(found: "Certificate") -> Iterator[str]:
    """Say that a slightly other scale changes the verdict, or may."""
    if math.isnan(found.margin) or found.margin > max(NEAR, found.wanted.nudge):
        return
    along, what = found.along, _driver(found.plan)
    if along.flip is not None and along.ended is not None and abs(along.flip) <= 2.0 * NEAR:
        way = "up" if along.flip > 0.0 else "down"
        yield f"with {what} scaled {way} by {_share(abs(along.flip))} {_ends(along.ended)}"
    elif not along.followed:
        yield (
            f"it depends on the scale of {what} in too intricate a way to be followed farther "
            f"than {_share(found.margin)}"
        )


def _range(found: "Certificate") -> str:
    """Say at which scales no other verdict was found."""
    if math.isnan(found.margin):
        return ""
    margin, along, what = found.margin, found.along, _driver(found.plan)
    low, high = (f"{1.0 + sign * margin:.6g}" for sign in (-1.0, 1.0))
    text = (
        f" No other verdict was found at the {along.within(margin)} scales of {what} tried from "
        f"{low} to {high}"
    )
    if not along.followed:
        return f"{text}; {found.wanted.runs} runs did not do to follow it farther."
    if along.flip is not None:
        return f"{text}; the nearest one with another verdict is {found.flip:.6g}."
    return f"{text}."


def _share(change: float) -> str:
    return f"{100.0 * change:.3g} %"


def _more(all_of: Sequence[object]) -> str:
    return f" (and {len(all_of) - 1} more)" if len(all_of) > 1 else ""


def _ends(shown: Beside) -> str:
    if shown.overturned is None:
        return "the run cannot be finished"
    return "it overturns" if shown.overturned else "it stands"


def _driver(plan: Plan) -> str:
    return "the motion" if plan.motion is not None else "the start"
