"""A certificate in one or two sentences."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from rockframe.simulation.beside import Beside
from rockframe.simulation.finer import SHORTER, tolerance_words
from rockframe.simulation.plan import Plan

if TYPE_CHECKING:
    from rockframe.simulation.certificate import Certificate

NEAR: Final = 0.01
"""A margin up to which a verdict is called near the boundary [1]."""


def sentence(found: "Certificate", values: Mapping[str, float | bool]) -> str:
    """Say what was tried and what was found.

    Parameters
    ----------
    found : Certificate
        The runs, for the names of what was tried.
    values : mapping of str to float or bool
        What came of it, as the dataset has it.

    Returns
    -------
    str
    """
    if not found.finished:
        return "No certificate: the run was not finished."
    ends = _Ends(found)
    near, flip = _near(found, values, ends), _nearest(found, values)
    doubts = [*_unsettled(found, values, ends), *_fragile(found, ends), *near]
    if doubts:
        text = f"Near the boundary: the body {ends.verdict}, but {'; '.join(doubts)}."
        said = near and _scaled_a_little(found, values)
        return text if said or not flip else f"{text} {flip.capitalize()}."
    means = [tolerance_words(found.plan.accuracy), f"steps {SHORTER:g} times shorter"]
    if found.plan.motion is not None:
        means.append("the motion cut finer")
    body = "The body"
    if found.base.in_motion:
        body = "To the end of the run, where it can still overturn, the body"
    text = (
        f"{body} {ends.verdict} also with {', '.join(means[:-1])} and {means[-1]}, and with every "
        f"parameter up to {100.0 * found.wanted.nudge:g} % larger or smaller"
    )
    scales = "; ".join(filter(None, [_tried(found, values), flip]))
    return f"{text}. {scales}." if scales else f"{text}."


class _Ends:
    """How runs end, in words, in the sense in which they were asked."""

    def __init__(self, found: "Certificate") -> None:
        stops = found.plan.stop_at_overturning
        self._words = {
            True: "overturns" if stops else "falls flat",
            False: "stands" if stops else "does not fall flat",
        }
        self.verdict = self._words[bool(found.base.overturned)]
        self.beyond = "overturn" if stops else "fall flat" if found.base.overturned else "come back"

    def of(self, shown: Beside) -> str:
        """Say how a run beside ended."""
        if shown.overturned is None:
            return "the run cannot be finished"
        return f"it {self._words[shown.overturned]}"


def _unsettled(
    found: "Certificate", values: Mapping[str, float | bool], ends: _Ends
) -> Iterator[str]:
    """Say which runs by finer means end otherwise, or come too near to it."""
    if values["verdict_converged"]:
        return
    verdict = found.base.overturned
    others = [(words, other) for words, other in found.finer if other.overturned != verdict]
    if others:
        words, other = others[0]
        yield f"with {words}{_more(others)} {ends.of(other)}"
    elif not found.base.within_the_angle:
        yield f"runs by finer means {ends.beyond} otherwise, or only just"
    else:
        yield (
            f"its peak rotation is uncertain by {values['peak_error_estimate']:.2g} rad, about "
            "what is left to overturning"
        )


def _fragile(found: "Certificate", ends: _Ends) -> Iterator[str]:
    """Say which parameters change the verdict."""
    changed = [(words, scan) for words, scan in found.nudged if scan.flip is not None]
    if changed:
        words, scan = changed[0]
        flip, ended = scan.flip or 0.0, scan.ended or found.base
        yield f"with the {words} {100.0 * flip:+.3g} %{_more(changed)} {ends.of(ended)}"
        return
    lost = [words for words, scan in found.nudged if not scan.followed]
    if lost:
        yield f"it depends on the {lost[0]}{_more(lost)} in too intricate a way to be followed"


def _near(found: "Certificate", values: Mapping[str, float | bool], ends: _Ends) -> list[str]:
    """Say that a slightly other scale changes the verdict, or may."""
    margin, along, what = values["verdict_margin"], found.along, _driver(found.plan)
    if not margin <= _little(found) or (along.followed and along.flip is None):
        return []
    if along.ended is not None and _scaled_a_little(found, values):
        change = values["verdict_flip_scale"] - 1.0
        way = "up" if change > 0.0 else "down"
        return [f"with {what} scaled {way} by {_share(abs(change))} {ends.of(along.ended)}"]
    return [
        f"it depends on the scale of {what} in too intricate a way to be followed farther "
        f"than {_share(margin)}"
    ]


def _little(found: "Certificate") -> float:
    """Give the change of scale up to which a flip is near."""
    return max(NEAR, found.wanted.nudge)


def _scaled_a_little(found: "Certificate", values: Mapping[str, float | bool]) -> bool:
    """Whether the flip that is known is near."""
    return abs(values["verdict_flip_scale"] - 1.0) <= 2.0 * _little(found)


def _tried(found: "Certificate", values: Mapping[str, float | bool]) -> str:
    """Say at which scales no other verdict was found; nothing where none was tried."""
    margin, along, what = values["verdict_margin"], found.along, _driver(found.plan)
    if math.isnan(margin):
        return ""
    low, high = (f"{1.0 + sign * margin:.6g}" for sign in (-1.0, 1.0))
    text = (
        f"No other verdict was found at the {along.within(margin)} scales of {what} tried from "
        f"{low} to {high}"
    )
    lost = f"; {found.wanted.runs} runs did not do to follow it farther"
    return text if along.followed else f"{text}{lost}"


def _nearest(found: "Certificate", values: Mapping[str, float | bool]) -> str:
    """Say at which scale another verdict is known; nothing where none is."""
    flip = values["verdict_flip_scale"]
    if math.isnan(flip):
        return ""
    return f"the nearest scale of {_driver(found.plan)} with another verdict is {flip:.6g}"


def _share(change: float) -> str:
    return f"{100.0 * change:.3g} %"


def _more(all_of: Sequence[object]) -> str:
    return f" (and {len(all_of) - 1} more)" if len(all_of) > 1 else ""


def _driver(plan: Plan) -> str:
    return "the motion" if plan.motion is not None else "the start"
