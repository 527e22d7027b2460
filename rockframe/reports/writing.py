"""``report``: a page on a run, to file or to print."""

import warnings
from html import escape
from os import PathLike
from pathlib import Path
from typing import Final

import xarray as xr

from rockframe.arguments import checked_dataset, text, truth
from rockframe.errors import RecordWarning, SchemaError
from rockframe.reports import page, sections
from rockframe.reports.certifying import certified
from rockframe.simulation.system import System
from rockframe.writing import FileKind, checked_path, generator, write_file

_OWNER: Final = "report"
_KIND: Final = FileKind.marked("a report", (".html", ".htm"), generator("report"))


def report(
    response: xr.Dataset,
    path: "str | PathLike[str]",
    *,
    title: str | None = None,
    certify: bool = True,
    overwrite: bool = False,
) -> Path:
    """Write a page on a run: one HTML file that needs no other and makes no request.

    Parameters
    ----------
    response : xarray.Dataset
        The result of one run, also one read back from a file.
    path : str or path
        Of the file; its name ends in ``.html``. A report that is there is replaced.
    title : str, optional
        Of the page; the model unless given.
    certify : bool, optional
        Whether a run without a certificate is certified first, where the dataset holds its
        motion; that takes some hundred runs.
    overwrite : bool, optional
        Whether a file that is there is replaced though it is no report.

    Returns
    -------
    Path
        The file. It shows the verdict with its certificate, the scene, the motion and its
        measures, all scalars, figures, limits of validity, and where the numbers come from.

    Raises
    ------
    SchemaError
        No dataset, or not the result of one run.
    ComponentError
        A title that is no text, or `certify` or `overwrite` neither True nor False.
    FileError
        The file cannot be written, its name has another ending, it is there already and no
        report, or it is the one that the result was read from.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockframe as rf
    >>> system = rf.System(rf.Block(width="1 m", height="4 m", mass="10 t"))
    >>> response = system.simulate(rf.GroundMotion.sine_pulse("-3 m/s^2", "2 Hz"))
    >>> rf.report(response, Path(tempfile.mkdtemp()) / "report.html", certify=False).name
    'report.html'
    """
    dataset = checked_dataset(response, owner=_OWNER)
    _check(dataset)
    truth(certify, owner=_OWNER, name="certify")
    given = "" if title is None else text(title, owner=_OWNER, name="title")
    source = str(dataset.encoding.get("source", ""))
    read = [source] if source else []
    # before the certificate, which takes a while
    checked_path(path, _KIND, overwrite=overwrite, read=read)
    system = _system_of(dataset)
    reason = ""
    if certify:
        dataset, reason = certified(dataset, system)
    model = str(dataset.attrs["model"])
    heading = given or f"Rocking response, {model} model"
    motion = None if system is None else system.motion
    made = str(dataset.attrs.get("history", "")).splitlines()
    body = [
        f"<header>\n{_heading(heading, made)}\n</header>",
        page.section("Verdict", sections.verdict_section(dataset, reason)),
        page.section("Response", sections.response_section(dataset)),
        page.section("Scene", sections.scene_section(dataset, system)),
        page.section("Ground motion", sections.motion_section(dataset, motion)),
        page.section("Limits of validity", sections.limits_section(system)),
        page.section("Provenance", sections.provenance_section(dataset, Path(source).name)),
    ]
    content = page.page(heading, body).encode()
    return write_file(path, _KIND, content, overwrite=overwrite, read=read)


def _heading(words: str, made: list[str]) -> str:
    lines = [f"<h1>{escape(words)}</h1>"]
    if made:
        lines.append(page.paragraph(made[-1], kind="soft"))
    return "\n".join(lines)


def _check(dataset: xr.Dataset) -> None:
    """Refuse what is not the result of one run."""
    needed = ("overturned", "status", "peak_rotation")
    missing = [name for name in needed if name not in dataset]
    if missing or "model" not in dataset.attrs:
        title = dataset.attrs.get("title", "without a title")
        msg = (
            f"{_OWNER}: found a dataset ({title}) that is no result of a run; expected that of "
            "system.simulate(motion)"
        )
        raise SchemaError(msg)
    dims = sorted({str(dim) for name in needed for dim in dataset[name].dims})
    if dims:
        msg = (
            f"{_OWNER}: found several runs over {', '.join(dims)}; expected one: simulate it with "
            "rf.case(runs, ...).simulate()"
        )
        raise SchemaError(msg)


def _system_of(dataset: xr.Dataset) -> System | None:
    """Give the system of a result with its motion; None where that cannot be had."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RecordWarning)  # said in words on the page
            return System.from_dataset(dataset)
    except SchemaError:
        return None
