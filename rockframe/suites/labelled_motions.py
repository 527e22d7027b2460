"""Labelled motions in an order: a mapping, a table of metadata, and selection."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any, Final, Self, cast

import pandas as pd

from rockframe.arguments import (
    checked_bool,
    checked_function,
    checked_list,
    checked_mapping,
    is_iterable,
    with_string_keys,
)
from rockframe.errors import (
    ComponentError,
    LabelError,
    RecordWarning,
    did_you_mean,
    short_repr,
    warn,
)
from rockframe.motion import GroundMotion
from rockframe.motion.display import peak_text
from rockframe.motion.pair import HorizontalPair, motion_hint
from rockframe.notebook import CELL_STYLE, TABLE_STYLE, html_summary, sparkline
from rockframe.results.joining import MOTION
from rockframe.results.schema import build_dataset
from rockframe.results.table import table as table_of
from rockframe.suggestions import SuggestingMeta, suggests_names
from rockframe.suites.columns import (
    check_column,
    known_columns,
    matching_labels,
    other_columns,
    sorted_labels,
)
from rockframe.suites.records import pairs_of
from rockframe.suites.target import TargetSpectrum

_EXAMPLE: Final = "rf.read_suite(path) reads files"


@suggests_names
class LabelledMotions(Mapping[str, GroundMotion], metaclass=SuggestingMeta):
    """Labelled motions in an order; immutable. A suite without its measures and targets."""

    __slots__ = ("_motions", "_remarks", "_target", "_unread", "_verticals")

    def __init__(
        self,
        motions: Mapping[str, GroundMotion] | Iterable[GroundMotion],
        *,
        verticals: Mapping[str, GroundMotion] | None = None,
        unread: Mapping[str, str] | None = None,
        remarks: Iterable[str] = (),
        target: TargetSpectrum | None = None,
    ) -> None:
        owner = type(self).__name__
        self._motions = _read_motions(motions, owner)
        self._verticals = {} if verticals is None else _read_motions(verticals, owner)
        files = {} if unread is None else unread
        example = "{'a.AT2': 'an empty file'}"
        self._unread = {**checked_mapping(files, owner=owner, name="unread", example=example)}
        self._remarks = tuple(checked_list(remarks, owner=owner, name="remarks", of="texts"))
        self._target = target
        if not self._motions:
            msg = f"{owner}: found no motions; expected one at least"
            raise ComponentError(msg)
        twice = [label for label in self._verticals if label in self._motions]
        if twice:
            msg = f"{owner}: {twice[0]!r} names a motion and a vertical component"
            raise ComponentError(msg)

    # a mapping ------------------------------------------------------------------------------

    def __getitem__(self, label: str) -> GroundMotion:
        try:
            return self._motions[label]
        except KeyError:  # as mappings have it
            msg = (
                "no motion of the suite is called "
                f"{short_repr(label)}{did_you_mean(label, self._motions)}"
            )
            raise LabelError(msg) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._motions)

    def __len__(self) -> int:
        return len(self._motions)

    def __repr__(self) -> str:
        labels = list(self._motions)
        listed = ", ".join(map(repr, labels[:3])) + (", ..." if len(labels) > 3 else "")
        parts = [f"{len(labels)} motion{'s' if len(labels) > 1 else ''}: {listed}"]
        if self._verticals:
            parts.append(f"{len(self._verticals)} vertical components")
        if self._unread:
            parts.append(f"{len(self._unread)} files not read")
        return f"<{type(self).__name__} of {'; '.join(parts)}>"

    # what is known --------------------------------------------------------------------------

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if not name.startswith("_")]

    def _repr_html_(self) -> str:
        return _suite_html(self)

    @property
    def verticals(self) -> Mapping[str, GroundMotion]:
        """Vertical components, by their labels."""
        return MappingProxyType(self._verticals)

    @property
    def unread(self) -> Mapping[str, str]:
        """Files that were not read, and why."""
        return MappingProxyType(self._unread)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on records that contradict themselves or do not make a pair."""
        return self._remarks

    @property
    def target(self) -> TargetSpectrum | None:
        """The spectrum that the motions were scaled or matched to, where they were compared."""
        return self._target

    @property
    def table(self) -> pd.DataFrame:
        """Metadata of the motions: a row for each, units in the names of the columns."""
        dataset = build_dataset(known_columns(self), {}, over=(MOTION,), title="Suite")
        frame = table_of(dataset.assign_coords({MOTION: (MOTION, list(self))}))
        for name, values in other_columns(self).items():
            frame[name] = values
        return frame

    @property
    def pairs(self) -> dict[str, HorizontalPair]:
        """Both horizontal components, and the vertical one, of records that have them."""
        return pairs_of(self._motions, self._verticals)

    # choosing -------------------------------------------------------------------------------

    def select(self, **criteria: Any) -> Self:
        """Keep the motions that meet all criteria.

        Parameters
        ----------
        **criteria
            By name of a column of `table`, without its unit: a range ``(lowest, highest)``,
            inclusive, where either may be None; a list of values; a function of the value in SI
            units; or one value. Values need units if the column has a unit.

        Returns
        -------
        MotionSuite
            The selected motions, with their vertical components.

        Raises
        ------
        UnitsError
            A value lacks a required unit, or has one of another kind.
        ComponentError
            No such column, or nothing is left.

        Examples
        --------
        >>> import rockframe as rf
        >>> motions = [rf.GroundMotion.stochastic(m, "20 km", seed=m) for m in (5, 6, 7)]
        >>> suite = rf.MotionSuite(motions)
        >>> len(suite.select(magnitude=(6, None)))
        2
        """
        labels = matching_labels(self, criteria)
        if not labels:
            requested = ", ".join(f"{name}={criterion!r}" for name, criterion in criteria.items())
            msg = f"{type(self).__name__}.select: no motion has {requested}"
            raise ComponentError(msg)
        return self.only(labels)

    def only(self, labels: Sequence[str]) -> Self:
        """Keep the motions with the given labels, in that order.

        Parameters
        ----------
        labels : sequence of str
            Labels.

        Returns
        -------
        MotionSuite

        Raises
        ------
        ComponentError
            There are no labels, or a label is unknown.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> suite.only(["2 Hz"])
        <MotionSuite of 1 motion: '2 Hz'>
        """
        owner = f"{type(self).__name__}.only"
        requested = checked_list(labels, owner=owner, name="labels", of="labels")
        unknown = [
            label for label in requested if not isinstance(label, str) or label not in self._motions
        ]
        if unknown:
            named = f"{short_repr(unknown[0])}{did_you_mean(unknown[0], self._motions)}"
            msg = f"{owner}: there is no motion {named}"
            raise ComponentError(msg)
        return self._with_motions({label: self._motions[label] for label in requested})

    def sort(self, by: str, *, descending: bool = False) -> Self:
        """Order the motions by a column; those without a value come last.

        Parameters
        ----------
        by : str
            A column of `table`, without its unit.
        descending : bool, optional
            Whether the greatest comes first.

        Returns
        -------
        MotionSuite

        Raises
        ------
        ComponentError
            No such column.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> [*suite.sort("duration")]
        ['2 Hz', '1 Hz']
        """
        checked_bool(descending, owner=f"{type(self).__name__}.sort", name="descending")
        check_column(self, by, owner=f"{type(self).__name__}.sort")
        return self.only(sorted_labels(self, by, descending=descending))

    # changing -------------------------------------------------------------------------------

    def changed(self, step: Callable[[GroundMotion], GroundMotion]) -> Self:
        """Apply a function to all motions, and to the vertical components.

        Parameters
        ----------
        step : callable
            Function that returns a new motion from the old one, such as ``lambda motion:
            motion.filtered(low="0.1 Hz")``.

        Returns
        -------
        MotionSuite

        Raises
        ------
        ComponentError
            The function does not return a motion.

        Examples
        --------
        >>> import rockframe as rf
        >>> suite = rf.MotionSuite(
        ...     {f"{f} Hz": rf.GroundMotion.sine_pulse("2 m/s^2", f"{f} Hz") for f in (1, 2)}
        ... )
        >>> print(suite.changed(lambda motion: motion.scaled(2))["1 Hz"].peak_acceleration)
        4.0 meter / second ** 2
        """
        step = checked_function(step, "motion", owner=f"{type(self).__name__}.changed", name="step")
        motions = {label: step(motion) for label, motion in self._motions.items()}
        verticals = {label: step(motion) for label, motion in self._verticals.items()}
        return type(self)(motions, verticals=verticals, unread=self._unread, remarks=self._remarks)

    def with_verticals(self) -> Self:
        """Add the vertical component of its record to each motion that has one.

        Returns
        -------
        MotionSuite
            With motions of both directions.

        Raises
        ------
        ComponentError
            A vertical component has another time step.

        Warns
        -----
        RecordWarning
            No motion has a vertical component: scaling each motion by itself, and matching, leave
            vertical components out.

        Examples
        --------
        >>> import rockframe as rf
        >>> across, up = (
        ...     rf.GroundMotion(rf.GroundMotion.sine_pulse(a, "1 Hz").si, metadata={"record": "R1"})
        ...     for a in ("3 m/s^2", "1 m/s^2")
        ... )
        >>> suite = rf.MotionSuite({"N": across}, verticals={"UP": up}).with_verticals()
        >>> print(suite["N"].vertical_acceleration.max().round(3))
        1.0 meter / second ** 2
        """
        by_record = {
            vertical.metadata.get("record"): vertical for vertical in self._verticals.values()
        }
        by_record.pop(None, None)
        motions: dict[str, GroundMotion] = {}
        for label, motion in self._motions.items():
            vertical = by_record.get(motion.metadata.get("record"))
            motions[label] = motion if vertical is None else motion.with_vertical(vertical)
        if all(motion.si.vertical is None for motion in motions.values()):
            words = (
                f"{type(self).__name__}.with_verticals: no motion has a vertical component; set "
                "them beside the motions before these are scaled one by one, or matched"
            )
            warn(words, RecordWarning)
        return self._with_motions(motions)

    def _with_motions(self, motions: Mapping[str, GroundMotion]) -> Self:
        records = {motion.metadata.get("record") for motion in motions.values()}
        verticals = {
            label: vertical
            for label, vertical in self._verticals.items()
            if vertical.metadata.get("record") in records
        }
        return type(self)(
            motions, verticals=verticals, unread=self._unread, remarks=self._remarks,
            target=self._target,
        )  # fmt: skip


def _read_motions(value: object, owner: str) -> dict[str, GroundMotion]:
    """Read motions with their labels."""
    motions: dict[str, Any] = {}
    if isinstance(value, Mapping):
        motions = with_string_keys(cast("Mapping[Any, Any]", value), owner=owner)
    elif is_iterable(value) and not isinstance(value, str):
        for motion in value:
            name = str(getattr(motion, "name", len(motions)))
            if name in motions:
                msg = f"{owner}: two motions are called {name!r}; give a mapping of labels"
                raise ComponentError(msg)
            motions[name] = motion
    else:
        msg = f"{owner}: motions must be several motions, got {short_repr(value)}; {_EXAMPLE}"
        raise ComponentError(msg)
    for label, motion in motions.items():
        if not isinstance(motion, GroundMotion):
            hint = motion_hint(motion) or f"; {_EXAMPLE}"
            msg = f"{owner}: {label!r} needs a GroundMotion, got {short_repr(motion)}{hint}"
            raise ComponentError(msg)
    return motions


_MAX_ROWS: Final = 8
"""Most motions that are shown in rows of their own."""


def _suite_html(suite: LabelledMotions) -> str:
    """Return a suite as HTML: its size, and curves of its first motions."""
    rows = {"motions": str(len(suite))}
    if suite.verticals:
        rows["vertical ones beside them"] = str(len(suite.verticals))
    if suite.unread:
        rows["files that could not be read"] = str(len(suite.unread))
    lines = "".join(
        f'<tr style="background:transparent"><td style="{CELL_STYLE}">{escape(label)}</td>'
        f'<td style="{CELL_STYLE}">{escape(peak_text(motion.si))}</td><td style="{CELL_STYLE}">'
        f"{sparkline(motion.si.horizontal.samples.tolist(), width=160.0, height=24.0)}</td></tr>"
        for label, motion in list(suite.items())[:_MAX_ROWS]
    )
    omitted = len(suite) - _MAX_ROWS
    more = f"<div>and {omitted} more; <code>suite.table</code> has all</div>" if omitted > 0 else ""
    table = f'<table style="{TABLE_STYLE}">{lines}</table>{more}'
    return html_summary(type(suite).__name__, rows, extra=table)
