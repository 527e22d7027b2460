"""Reading files into a suite."""

from collections.abc import Iterable
from pathlib import PurePath
from typing import Final

from rockframe.errors import PLEASE_REPORT, ComponentError, RecordError, RecordWarning, warn
from rockframe.motion import GroundMotion
from rockframe.motion.constructors.records import motion_of_reading
from rockframe.motion.value import one_line
from rockframe.records import (
    Known,
    Reading,
    RecordLike,
    Request,
    Source,
    Unread,
    files_of,
    peer_table,
    read_components,
    request_of,
)
from rockframe.suggestions import with_hints
from rockframe.suites.records import RecordedComponent, assign_records, sequence_number_of
from rockframe.suites.stored import is_stored_suite, stored_suite
from rockframe.suites.suite import MotionSuite
from rockframe.units import QuantityLike

_OWNER: Final = "read_suite"
_OTHER_MOTIONS: Final = {".vt2": "a velocity", ".dt2": "a displacement"}
_COMPANIONS: Final = (*_OTHER_MOTIONS, ".pdf", ".xml")
"""Endings of files that come with records but are none: they are skipped without a warning."""
_MAX_LISTED: Final = 3


@with_hints()
def read_suite(
    path: RecordLike | Iterable[RecordLike],
    *,
    format: str | None = None,  # noqa: A002
    unit: str | None = None,
    time_step: QuantityLike | None = None,
) -> MotionSuite:
    r"""Read all records of a folder, of an archive, or of a list of files.

    Parameters
    ----------
    path : str, path-like, bytes or file object, or iterable of these
        A folder, read with its subfolders; a zip or tar archive (also ``.tar.gz``), such as an
        unmodified download of the PEER database; one file; or several of these. ``~`` is the user's
        home folder. Also a netCDF file of :meth:`MotionSuite.to_dataset`.
    format : str, optional
        A name of :func:`rockframe.motion.formats` for all files; by default it is recognised.
    unit : str, optional
        Unit of the samples, if files do not state it, as for :meth:`GroundMotion.read`.
    time_step : str or Quantity, optional
        Time step, for columns of samples without times [s].

    Returns
    -------
    MotionSuite
        All components that could be read, in the order of the files; horizontal ones as motions,
        vertical ones in `verticals`. Files that could not be read are in ``unread``.

    Raises
    ------
    RecordError
        There is no such file or folder, an archive is damaged or malicious, or there is no
        horizontal component; the message says why the first files were not read.
    UnitsError
        `unit` is not an acceleration, or `time_step` not a time.
    ComponentError
        `format` is unknown.

    Warns
    -----
    RecordWarning
        Files were not read, or their content is unusual; one warning for all files.

    Notes
    -----
    Components are grouped by the record sequence number of PEER, in file names or in the table
    ``_SearchResults.csv``, else by station and earthquake, else by file. Of files with the same
    content only the first is read. The content of the table is added to the metadata. Nothing is
    unpacked to disk. An archive may expand to a hundred times its size; archives in archives in it
    are not opened, and links and names that lead out of it are not followed.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> folder = Path(tempfile.mkdtemp())
    >>> for name, peak in (("north", 0.1), ("east", 0.2)):
    ...     text = f"time (s),acceleration (g)\n0,0\n0.01,{peak}\n0.02,-0.1\n"
    ...     _ = (folder / f"{name}.csv").write_text(text)
    >>> list(read_suite(folder))
    ['east', 'north']
    """
    request = request_of(owner=_OWNER, unit=unit, time_step=time_step)
    reader = _SuiteReader()
    for file in files_of(path):
        if isinstance(file, Unread):
            reader.unread.append(file)
        elif is_stored_suite(file):
            return stored_suite(file, MotionSuite.from_dataset)
        else:
            reader.read(file, format, request)
    reader.complete()
    horizontal, verticals = (
        {part.label: part.with_metadata() for part in reader.components if part.vertical is upright}
        for upright in (False, True)
    )
    if not horizontal:
        raise _no_motions_error(str(path), reader, len(verticals))
    _warn_of_unread(reader)
    reasons = {file.path: file.reason for file in reader.unread}
    return MotionSuite(horizontal, verticals=verticals, unread=reasons, remarks=reader.remarks)


class _SuiteReader:
    """Components, tables and faults found so far."""

    def __init__(self) -> None:
        self.components: list[RecordedComponent] = []
        self.unread: list[Unread] = []
        self.remarks: list[str] = []
        self._tables: dict[str, Known] = {}
        self._table = ""
        self._labels: set[str] = set()
        self._digests: dict[str, str] = {}

    def read(self, file: Source, format_name: str | None, request: Request) -> None:
        """Read a file, or record why it was not read."""
        quantity = _OTHER_MOTIONS.get(file.suffix)
        if quantity is not None:
            self.unread.append(Unread(file.path, f"found {quantity}; expected an acceleration"))
            return
        try:
            table = peer_table(file)
            if table is not None:
                self._tables |= table
                self._table = file.path
                return
            readings = read_components(file, format_name, request)
        except RecordError as problem:
            self.unread.append(Unread.of(file.path, problem))
            return
        except ComponentError:
            raise
        except Exception as problem:
            # a fault of a reader excludes one file, not the folder, and is reported as such
            reason = f"found what the reader fails at ({type(problem).__name__}: {problem})"
            self.unread.append(Unread(file.path, f"{reason[:300]}; {PLEASE_REPORT}"))
            return
        if file.sha256 in self._digests:
            reason = f"found a copy of {self._digests[file.sha256]}; expected each record once"
            self.unread.append(Unread(file.path, reason))
            return
        self._digests[file.sha256] = file.path
        number = len(self._digests)
        for reading in readings:
            if isinstance(reading, RecordError):
                self.unread.append(Unread.of(reading.path, reading))
                continue
            self.remarks += [warning for warning in reading.warnings if warning not in self.remarks]
            label = self._label(reading, alone=len(readings) == 1)
            motion = motion_of_reading(GroundMotion, reading, label)
            component = RecordedComponent(label, motion, reading.vertical, file.path, number)
            sequence_number = sequence_number_of(reading.file)
            if sequence_number is not None:
                component.added_metadata["record_sequence_number"] = sequence_number
            self.components.append(component)

    def complete(self) -> None:
        """Add the metadata of tables, and group components."""
        tables = {name.casefold(): metadata for name, metadata in self._tables.items()}
        matched: set[str] = set()
        for component in self.components:
            name = str(component.motion.metadata.get("source_file", "")).casefold()
            if name in tables:
                matched.add(name)
                component.added_metadata |= tables[name]
                component.vertical = component.vertical or tables[name].get("axis") == "V"
        self.unread += [
            Unread(f"{self._table}: {name}", "found no such file; expected it beside the table")
            for name in self._tables
            if name.casefold() not in matched
        ]
        self.remarks += assign_records(self.components)

    def _label(self, reading: Reading, *, alone: bool) -> str:
        stem = one_line(reading.name or PurePath(reading.file).stem)
        plain = stem if alone else f"{stem} {reading.metadata.get('component', '')}".strip()
        label, count = plain, 1
        while label in self._labels:
            count += 1
            label = f"{plain} ({count})"
        self._labels.add(label)
        return label


def _no_motions_error(path: str, reader: _SuiteReader, vertical_count: int) -> RecordError:
    count = vertical_count + len(reader.unread)
    missing = f"no horizontal component in {count} file{'' if count == 1 else 's'}"
    if vertical_count:
        missing += f", {vertical_count} vertical ones"
    listed = "; ".join(f"{file.path}: {file.reason}" for file in reader.unread[:_MAX_LISTED])
    expected = "records of ground motions" + (f" (not read: {listed[:600]})" if listed else "")
    place = path if len(path) <= 200 else f"{path[:197]}..."
    return RecordError(place, found=missing, expected=expected)


def _warn_of_unread(reader: _SuiteReader) -> None:
    """Warn once, for all files together."""
    unread = [file for file in reader.unread if not file.path.casefold().endswith(_COMPANIONS)]
    words: list[str] = []
    if unread:
        listed = "; ".join(
            f"{PurePath(file.path).name}: {file.reason}" for file in unread[:_MAX_LISTED]
        )
        files = "1 file" if len(unread) == 1 else f"{len(unread)} files"
        words.append(f"{files} not read ({listed}; suite.unread lists all)")
    if reader.remarks:
        listed = "; ".join(reader.remarks[:_MAX_LISTED])
        words.append(f"{len(reader.remarks)} worth a look ({listed}; suite.remarks lists all)")
    if words:
        warn(f"{_OWNER}: {'; '.join(words)}", RecordWarning)
