"""The folder of a study: what has been planned, and what has been run so far.

``study.json`` says what the study is; ``labels.arrays`` holds axes and motions; each chunk has a
file, in one of several folders where there are very many. Files appear whole or not at all. Several
processes may work on one study: they write the same bytes, and none runs what it finds done.
"""

import hashlib
import json
import os
import time
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from rockframe.errors import StudyError
from rockframe.motion import GroundMotion
from rockframe.results.points import BodyPoint
from rockframe.results.schema import SOURCE, history_line
from rockframe.signals.arrays import AnyArray
from rockframe.studies.sweeps.axes import Axis, Chunk, Grid, chunks_of
from rockframe.studies.sweeps.chunk import CaseResults
from rockframe.studies.sweeps.identity import difference
from rockframe.studies.sweeps.labelling import SweepLabels, sweep_labels
from rockframe.studies.sweeps.study import Histories, Study
from rockframe.version import __version__

_MAGIC: Final = b"rockframe arrays 1 "
_DIGEST_LENGTH: Final = 64
_REMEDY: Final = "remove the file, and the same sweep makes it again"
"""What to do about a damaged file."""
_BLOCK: Final = 4096
"""Usual allocation unit of file systems [bytes]."""


def write_arrays(path: Path, described: Mapping[str, Any], arrays: Mapping[str, AnyArray]) -> None:
    """Write arrays to a file, with a description and a checksum."""
    plain = {
        name: np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
        for name, values in arrays.items()
    }
    shapes = [[name, values.dtype.str, list(values.shape)] for name, values in plain.items()]
    line = json.dumps({"described": dict(described), "arrays": shapes})
    body = b"".join([line.encode(), b"\n", *(values.tobytes() for values in plain.values())])
    digest = hashlib.sha256(body).hexdigest().encode()
    write_atomically(path, b"".join([_MAGIC, digest, b"\n", body]))


def read_arrays(path: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """Read the description and the arrays of a file."""
    try:
        content = path.read_bytes()
    except OSError as problem:
        msg = f"{path} cannot be read: {problem}"
        raise StudyError(msg) from problem
    start = len(_MAGIC) + _DIGEST_LENGTH + 1
    if not content.startswith(_MAGIC):
        msg = (
            f"{path}: found no file of a study; expected one that begins with {_MAGIC.decode()!r}; "
            f"{_REMEDY}"
        )
        raise StudyError(msg)
    digest, body = content[len(_MAGIC) : start - 1], memoryview(content)[start:]
    if hashlib.sha256(body).hexdigest().encode() != digest:
        msg = (
            f"{path}: damaged: its contents ({len(content)} bytes) are not those that were "
            f"written; {_REMEDY}"
        )
        raise StudyError(msg)
    end = content.index(b"\n", start)
    head = json.loads(content[start:end])
    arrays: dict[str, AnyArray] = {}
    place = end + 1
    for name, kind, shape in head["arrays"]:
        dtype = np.dtype(kind)
        count = int(np.prod(shape, dtype=np.int64))
        arrays[name] = np.frombuffer(content, dtype, count, place).reshape(shape).copy()
        place += count * dtype.itemsize
    return head["described"], arrays


def read_shapes(path: Path) -> dict[str, tuple[int, ...]]:
    """Read which arrays a file has, and their shapes, without reading the arrays."""
    with path.open("rb") as file:
        file.readline()
        try:
            head = json.loads(file.readline())
            return {name: tuple(shape) for name, _, shape in head["arrays"]}
        except (ValueError, KeyError, TypeError) as problem:
            msg = f"{path}: damaged: {problem}; {_REMEDY}"
            raise StudyError(msg) from problem


def write_atomically(path: Path, content: bytes, *, replace: bool = True) -> None:
    """Write a file atomically, even if this process is killed."""
    part = path.with_name(f".{path.name}.{os.getpid()}.{os.urandom(4).hex()}.part")
    try:
        with part.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if replace:
            part.replace(path)
            return
        try:
            path.hardlink_to(part)
        except (OSError, NotImplementedError):  # there is one, or the file system has no links
            if not path.exists():
                part.replace(path)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


FORMAT: Final = 3
FOLDER_FORMAT: Final = 4
"""Format of studies whose many chunks are in several folders."""
MAX_FILES_PER_FOLDER: Final = 1000
"""Most chunks of a folder; file systems, and tools that list folders, are slow with many more."""
_OBSOLETE_FORMATS: Final = (1, 2)
"""Formats with motions in another order, whose digests left out what functions use."""
_STUDY: Final = "study.json"
_LABELS: Final = "labels.arrays"
_FOLDERS: Final = "chunks-*/"
_STALE_AGE: Final = 3600.0
"""Age from which on a half-written file belongs to a process that was killed [s]."""
_COLUMN: Final = "motion of case"
_SCALAR, _HISTORY, _MOTION = "scalar ", "history ", "motion "
_CHUNK_ARRAYS: Final = ("status", "message")
"""Arrays of every chunk besides scalars and histories."""
_SAMPLED: Final = ("horizontal", "vertical")


@dataclass(frozen=True)
class Store:
    """A folder that holds a study."""

    folder: Path  # the folder
    digest: str  # of the study
    cases: int  # number of cases
    chunk: int  # cases of a chunk
    history: str  # when the study was begun, for the history of its dataset
    version: str  # of rockframe, whose numbers these are
    in_folders: bool  # whether chunks are in several folders

    @classmethod
    def open_or_create(cls, path: Path, study: Study, chunk: int) -> "Store":
        """Open the folder of a study, or make it."""
        with _writing_to(path):
            _create(path, study, chunk)
            for part in (*path.glob(".*.part"), *path.glob(f"{_FOLDERS}.*.part")):
                with suppress(OSError):
                    if time.time() - part.stat().st_mtime > _STALE_AGE:
                        part.unlink()
        head = _read_head(path)
        if head["rockframe_version"] != __version__:
            msg = (
                f"{path}: found a study of rockframe {head['rockframe_version']}, whose numbers "
                f"may be others than those of this one, {__version__}; it can be read "
                "(rf.open_study) and not gone on with: run the study again, in another folder"
            )
            raise StudyError(msg)
        if head["study_sha256"] != study.digest:
            differs = difference(head["study"], json.loads(json.dumps(study.to_dict())))
            msg = (
                f"{path}: found another study, which differs in {', '.join(differs)}; expected "
                "the requested one: give another folder; to extend this study by motions "
                f"or by values along its axes, give known={str(path)!r} too"
            )
            raise StudyError(msg)
        if not (path / _LABELS).exists():  # new, or removed, as damaged files should be
            with _writing_to(path):
                _write_labels(path, study)
        return cls._from_head(path, head)

    @classmethod
    def open(cls, path: Path) -> "Store":
        """Open a folder that holds a study."""
        return cls._from_head(path, _read_head(path))

    @classmethod
    def _from_head(cls, path: Path, head: Mapping[str, Any]) -> "Store":
        return cls(
            path, head["study_sha256"], head["cases"], head["cases_of_a_chunk"], head["history"],
            head["rockframe_version"], head["format"] == FOLDER_FORMAT,
        )  # fmt: skip

    def provenance(self) -> dict[str, str]:
        """Return the attributes of provenance."""
        return {
            "history": self.history,
            "source": f"rockframe {self.version}, {SOURCE}",
            "rockframe_version": self.version,
        }

    def description(self) -> dict[str, Any]:
        """Return the description of the study made when it was begun."""
        return _read_head(self.folder)["study"]

    def chunks(self) -> list[Chunk]:
        """Return all chunks."""
        return chunks_of(self.cases, self.chunk)

    def chunk_at(self, number: int) -> Chunk:
        """Return a chunk by its number."""
        return Chunk.of(number, self.cases, self.chunk)

    def has(self, chunk: Chunk) -> bool:
        """Whether a chunk has been run."""
        return self._file(chunk).exists()

    def put(self, chunk: Chunk, rows: CaseResults) -> None:
        """Store the results of a chunk."""
        arrays = dict(zip(_CHUNK_ARRAYS, (rows.status, rows.message), strict=True))
        for kind, columns in ((_SCALAR, rows.scalars), (_HISTORY, rows.histories)):
            arrays |= {f"{kind}{name}": values for name, values in sorted(columns.items())}
        file = self._file(chunk)
        try:
            if self.in_folders:
                file.parent.mkdir(exist_ok=True)
            write_arrays(file, self._described(chunk) | {"texts": rows.texts}, arrays)
        except OSError as problem:
            msg = (
                f"{file} cannot be written: {problem}; all chunks before it are stored, and the "
                "same call continues from there"
            )
            raise StudyError(msg) from problem

    def check_writable(self) -> None:
        """Check that results can be stored, before hours of work."""
        part = self.folder / f".{os.getpid()}.{os.urandom(4).hex()}.part"
        try:
            with _writing_to(self.folder):
                part.write_bytes(bytes(_BLOCK))
        finally:
            with suppress(OSError):
                part.unlink(missing_ok=True)

    def get(self, chunk: Chunk) -> CaseResults:
        """Read the results of a chunk."""
        file = self._file(chunk)
        described, arrays = read_arrays(file)
        texts = described.pop("texts", ())
        if described != self._described(chunk):
            msg = (
                f"{file}: found a chunk of another study; expected one of the study beside it, "
                f"{self.digest[:12]}..., with the cases {chunk.cases.start} to "
                f"{chunk.cases.stop - 1}"
            )
            raise StudyError(msg)
        status, message = (arrays.pop(name) for name in _CHUNK_ARRAYS)
        scalars, histories = (
            {n.removeprefix(kind): values for n, values in arrays.items() if n.startswith(kind)}
            for kind in (_SCALAR, _HISTORY)
        )
        return CaseResults(status, scalars, histories, message, tuple(texts))

    def results(self) -> Iterator[tuple[range, CaseResults]]:
        """Return all stored results."""
        for chunk in self.chunks():
            if self.has(chunk):
                yield chunk.cases, self.get(chunk)

    def contents(self) -> tuple[dict[str, tuple[int, ...]], int]:
        """Return the stored scalars and histories, with their shapes per case; count chunks."""
        files = [self._file(chunk) for chunk in self.chunks() if self.has(chunk)]
        shapes: dict[str, tuple[int, ...]] = {}
        for file in files:
            for name, shape in read_shapes(file).items():
                if name.startswith((_SCALAR, _HISTORY)):
                    plain = name.removeprefix(_SCALAR).removeprefix(_HISTORY)
                    # of unlike numbers of bodies or restrainers there is room for the most
                    shapes[plain] = tuple(map(max, shapes.get(plain, shape[1:]), shape[1:]))
        return shapes, len(files)

    def labels(self) -> SweepLabels:
        """Read the labels of the study."""
        described, arrays = self._read_labels()
        axes, columns = (
            tuple(
                Axis.from_dict(axis, arrays[axis["name"]] if words is None else np.array(words))
                for axis, words in described[kind]
            )
            for kind in ("axes", "columns")
        )
        names = tuple(name for name, _ in described["motions"])
        grid = Grid(axes, columns, len(names), arrays.get(_COLUMN))
        histories = None
        if (kept := described["histories"]) is not None:
            which = None if kept["names"] is None else tuple(kept["names"])
            histories = Histories(which, kept["step"], kept["count"])
        points = tuple(BodyPoint(**point) for point in described["points"])
        return SweepLabels(grid, names, histories, points, described["attributes"])

    def motions(self) -> dict[str, GroundMotion | None]:
        """Read the motions of the study."""
        described, arrays = self._read_labels()
        for k, (_, description) in enumerate(described["motions"]):
            for component, held in _sampled_components(description).items():
                for what in held:
                    held[what] = arrays[f"{_MOTION}{k} {component} {what}"]
        return {
            name: None if description is None else GroundMotion.from_dict(description)
            for name, description in described["motions"]
        }

    def check_folder(self) -> None:
        """Raise an error if the folder does not hold the study any more."""
        if _read_head(self.folder)["study_sha256"] != self.digest:
            msg = f"{self.folder}: found another study than before, {self.digest[:12]}..."
            raise StudyError(msg)

    def _read_labels(self) -> tuple[dict[str, Any], dict[str, AnyArray]]:
        file = self.folder / _LABELS
        described, arrays = read_arrays(file)
        if described.get("attributes", {}).get("study_sha256") != self.digest:
            msg = (
                f"{file}: found labels of another study; expected those of the study beside it, "
                f"{self.digest[:12]}...; {_REMEDY}"
            )
            raise StudyError(msg)
        return described, arrays

    def _file(self, chunk: Chunk) -> Path:
        file = f"chunk-{chunk.number:06d}.arrays"
        if not self.in_folders:
            return self.folder / file
        return self.folder / f"chunks-{chunk.number // MAX_FILES_PER_FOLDER:04d}" / file

    def _described(self, chunk: Chunk) -> dict[str, Any]:
        return {
            "study_sha256": self.digest,
            "first_case": chunk.cases.start,
            "last_case": chunk.cases.stop - 1,
        }


@contextmanager
def _writing_to(folder: Path) -> Generator[None]:
    """Raise an error of rockframe if the folder of a study cannot be written."""
    try:
        yield
    except OSError as problem:
        msg = f"the study cannot be kept in {folder}: {problem}"
        raise StudyError(msg) from problem


def _create(path: Path, study: Study, chunk: int) -> None:
    """Write what a study is, unless the folder has one, which stays what it is."""
    if (path / _STUDY).exists():
        return
    path.mkdir(parents=True, exist_ok=True)
    many = study.grid.count > MAX_FILES_PER_FOLDER * chunk
    head = {
        "format": FOLDER_FORMAT if many else FORMAT,
        "rockframe_version": __version__,
        "history": history_line("begun"),
        "study_sha256": study.digest,
        "cases": study.grid.count,
        "cases_of_a_chunk": chunk,
        "study": study.to_dict(),
    }
    text = json.dumps(head, indent=1)
    write_atomically(path / _STUDY, f"{text}\n".encode(), replace=False)


def _write_labels(path: Path, study: Study) -> None:
    """Write axes and motions; only once the folder is that of the study, not of another job's."""
    labels = sweep_labels(study)
    arrays: dict[str, AnyArray] = {}
    described: dict[str, Any] = {
        "attributes": dict(labels.attributes),
        "histories": None if labels.histories is None else vars(labels.histories),
        "points": [vars(point) for point in labels.points],
        "motions": [],  # in their order, in which cases are counted
    }
    for kind, axes in (("axes", labels.grid.axes), ("columns", labels.grid.columns)):
        described[kind] = [(axis.to_dict(), _word_values(axis)) for axis in axes]
        arrays |= {axis.name: axis.values for axis in axes if _word_values(axis) is None}
    if labels.grid.motion_column is not None:
        arrays[_COLUMN] = labels.grid.motion_column
    for k, (name, motion) in enumerate(study.motions.items()):
        description = None if motion is None else motion.to_dict(samples=True)
        for component, held in _sampled_components(description).items():
            for what, values in held.items():
                arrays[f"{_MOTION}{k} {component} {what}"] = np.array(values)
                held[what] = None
        described["motions"].append((name, description))
    write_arrays(path / _LABELS, described, arrays)


def _word_values(axis: Axis) -> list[str] | None:
    """Return the values of an axis that are words."""
    return axis.values.tolist() if axis.values.dtype.kind == "U" else None


def _sampled_components(description: Mapping[str, Any] | None) -> dict[str, dict[str, Any]]:
    """Return the components that a motion is described by, where it is described by samples."""
    # what a constructor makes is described by its arguments, and ``vertical`` may be one of them
    if description is None or description["constructor"] is not None:
        return {}
    return {component: description[component] for component in _SAMPLED if description[component]}


def _read_head(path: Path) -> dict[str, Any]:
    file = path / _STUDY
    try:
        head: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        version, form = head["rockframe_version"], head["format"]
        is_complete = {"study_sha256", "cases", "cases_of_a_chunk", "history", "study"} <= set(head)
    except FileNotFoundError as problem:
        msg = f"{path}: found no study; expected a folder with {_STUDY}"
        raise StudyError(msg) from problem
    except OSError as problem:
        msg = f"{file} cannot be read: {problem}"
        raise StudyError(msg) from problem
    except (ValueError, KeyError, TypeError) as problem:
        msg = f"{file}: damaged: {problem}"
        raise StudyError(msg) from problem
    if form not in (FORMAT, FOLDER_FORMAT):
        uncertain = "which does not tell for certain whose results it holds"
        why = uncertain if form in _OBSOLETE_FORMATS else "which this version cannot read"
        msg = (
            f"{path}: found a study of rockframe {version} (format {form}), {why}; this is "
            f"rockframe {__version__} (formats {FORMAT} and {FOLDER_FORMAT}): run the study again, "
            "in another folder"
        )
        raise StudyError(msg)
    if not is_complete:
        msg = f"{file}: damaged: entries are missing"
        raise StudyError(msg)
    return head


def staggered(chunks: list[Chunk]) -> list[Chunk]:
    """Let each process begin elsewhere, so that several on one study seldom ask for the same."""
    first = (os.getpid() * 2_654_435_761) % len(chunks) if chunks else 0
    return [*chunks[first:], *chunks[:first]]
