"""Suites as notebooks show them."""

from html import escape
from typing import TYPE_CHECKING, Final

from rockframe.motion.html import peak_words
from rockframe.notebook import CELL, TABLE, card, curve

if TYPE_CHECKING:
    from rockframe.suites.suite import MotionSuite

_SHOWN: Final = 8
"""Motions that have a row of their own."""


def suite_html(suite: "MotionSuite") -> str:
    """Give number, and curves of the first motions, of a suite as HTML."""
    rows = {"motions": str(len(suite))}
    if suite.verticals:
        rows["vertical ones beside them"] = str(len(suite.verticals))
    if suite.unread:
        rows["files that could not be read"] = str(len(suite.unread))
    lines = "".join(
        f'<tr style="background:transparent"><td style="{CELL}">{escape(label)}</td>'
        f'<td style="{CELL}">{escape(peak_words(motion))}</td><td style="{CELL}">'
        f"{curve(motion.si.horizontal.samples.tolist(), width=160.0, height=24.0)}</td></tr>"
        for label, motion in list(suite.items())[:_SHOWN]
    )
    left = len(suite) - _SHOWN
    more = f"<div>and {left} more; <code>suite.table</code> has all</div>" if left > 0 else ""
    table = f'<table style="{TABLE}">{lines}</table>{more}'
    return card(type(suite).__name__, rows, more=table)
