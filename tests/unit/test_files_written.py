"""Written files replace no inputs or foreign files, and are never left incomplete."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.main import main
from rockframe.errors import FileError
from rockframe.reports import page
from rockframe.writing import FileKind, write_file

pytestmark = pytest.mark.unit
STUDY = 'scene = "scene.toml"\nmotions = ["record.AT2"]\n[axes]\nscale = [0.5, 1.0]\n'


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Return all files that commands read, and one of each kind that they write."""
    folder = tmp_path_factory.mktemp("written")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        # as the fixture no_pictures, which has function scope
        patch.setattr(page, "_rendered", lambda figure, kind: b"<svg/>")
        scene = TEMPLATES["block"].split("[run]", maxsplit=1)[0]
        Path("scene.toml").write_text(scene + '[run]\naccuracy = "fast"\n')
        rf.GroundMotion.sine_pulse("-4 m/s^2", "1 Hz").to_at2("record.AT2")
        Path("study.toml").write_text(STUDY)
        Path("kept").mkdir()
        Path("kept/other.AT2").write_bytes(Path("record.AT2").read_bytes())
        for words in (
            "run scene.toml -o run.nc",
            "study study.toml -o study.nc --csv study.csv",
            "motion record.AT2 --csv motion.csv --picture motion.png",
            "plot run.nc -o run.svg",
            "plot run.nc -o run.pdf",
            "report run.nc --no-certificate",
        ):
            assert main(words.split()) == 0
        moving = rf.plot.animation(xr.load_dataset("run.nc"), frames_per_second=2)
        moving.save("run.gif", dpi=20)
        moving.save("moving.html")
        rf.GroundMotion.read("record.AT2").to_dataset().to_netcdf("motion.nc")
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*.*")}


@pytest.fixture
def folder(tmp_path, monkeypatch, written):
    """Change to a folder with copies of these files."""
    for path, content in written.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_bytes(content)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


REFUSED = {
    # an input, under any of its names
    "run scene.toml -o scene.toml --overwrite": "the result of a run ends in .nc",
    "certify scene.toml -o scene.toml --overwrite": "ends in .nc",
    "run scene.toml -m motion.nc -o motion.nc --overwrite": "this file is an input",
    "run scene.toml -m motion.nc -o ./kept/../motion.nc --overwrite": "this file is an input",
    "run scene.toml -m motion.nc -o soft.nc --overwrite": "this file is an input",
    "run scene.toml -m motion.nc -o hard.nc --overwrite": "this file is an input",
    "run inner.toml -o motion.nc --overwrite": "this file is an input",
    "study study.toml --csv study.toml --overwrite": "ends in .csv",
    "study cases.toml --csv study.csv --overwrite": "this file is an input",
    "study stored.toml -o motion.nc --overwrite": "this file is an input",
    "study all.toml --csv kept/some.csv --overwrite": "this file is an input",
    "motion record.AT2 --csv record.AT2 --overwrite": "a table of measures ends in .csv",
    "motion column.csv --unit g --csv column.csv --overwrite": "this file is an input",
    "motion kept --csv kept/some.csv --overwrite": "in the input folder 'kept'",
    "plot run.nc -o run.nc --overwrite": "a picture ends in .png or .svg or .pdf",
    "report run.nc -o run.nc --overwrite": "a report ends in .html or .htm",
    "report odd.html --overwrite": "this file is an input",
    # files of other programs, or of another kind
    "run scene.toml -o mine.nc": "not the result of a run that rockframe wrote",
    "run scene.toml -o motion.nc": "not the result of a run that rockframe wrote",
    "run scene.toml -o study.nc": "not the result of a run that rockframe wrote",
    "certify scene.toml -o mine.nc": "not the result of a run",
    "study study.toml -o run.nc": "not the result of a study",
    "study output.toml": "not the result of a study",
    "study study.toml --csv mine.csv": "not the table of a study",
    "study study.toml --csv motion.csv": "not the table of a study",
    "motion record.AT2 --csv study.csv": "not a table of measures",
    "motion record.AT2 --csv mine.csv": "not a table of measures",
    "motion record.AT2 --picture mine.png": "not a picture that rockframe wrote",
    "motion record.AT2 kept --picture mine.png": "mine-2.png: this file exists already",
    "plot run.nc -o mine.svg": "not a picture that rockframe wrote",
    "plot run.nc -o mine.pdf": "not a picture that rockframe wrote",
    "report run.nc -o mine.html": "not a report that rockframe wrote",
    "report run.nc -o moving.html": "not a report that rockframe wrote",
    "report mine.nc": "not a report that rockframe wrote",
    "report mine.nc -o new.html": "no result of a run",
    # unsuitable names
    "run scene.toml -o out": "the name has no ending",
    "run scene.toml -o out.csv": "ends in '.csv'",
    "run scene.toml -o kept": "this is a folder",
    "run scene.toml -o none/out.nc": "there is no folder 'none'",
    "run scene.toml -o pipe.nc --overwrite": "this is not a regular file",
    "plot run.nc -o out.jpg": "ends in '.jpg'",
    "report run.nc -o report.pdf": "ends in '.pdf'",
    "motion record.AT2 --picture record": "the name has no ending",
}


def write_foreign_files():
    """Create files that rockframe has not written, and links to its inputs."""
    xr.Dataset({"x": ("t", [1.0])}, attrs={"source": "my own"}).to_netcdf("mine.nc")
    for ending in ("csv", "png", "svg", "pdf", "html"):
        Path(f"mine.{ending}").write_text("a report by rockframe 0.1.0, status, overturned\n1,2\n")
    Path("mine-2.png").write_text("mine")
    Path("soft.nc").symlink_to("motion.nc")
    Path("hard.nc").hardlink_to("motion.nc")
    Path("odd.html").write_bytes(Path("run.nc").read_bytes())
    os.mkfifo("pipe.nc")
    block = Path("scene.toml").read_text().split("[motion]", maxsplit=1)[0]
    Path("inner.toml").write_text(block + '[motion]\nfile = "motion.nc"\n')
    Path("stored.toml").write_text(STUDY.replace("record.AT2", "mot*.nc"))
    Path("output.toml").write_text('output = "mine.nc"\n' + STUDY)
    Path("cases.toml").write_text('scene = "scene.toml"\ncases = "study.csv"\n')
    Path("study.csv").write_text("scale\n0.5\n")
    rows = [f"{0.01 * k:.2f},{0.1 * (k % 3)}" for k in range(50)]
    Path("column.csv").write_text("\n".join(["time [s],a [g]", *rows]))
    Path("kept/some.csv").write_bytes(Path("column.csv").read_bytes())
    Path("all.toml").write_text(STUDY.replace("record.AT2", "kept/*.*"))


@pytest.mark.wide
@pytest.mark.parametrize("words", REFUSED)
def test_commands_do_not_replace_inputs_or_foreign_files(words, folder, capsys):
    write_foreign_files()
    before = contents(folder)
    assert main(words.split()) == 2
    stderr = capsys.readouterr().err
    assert REFUSED[words] in stderr
    assert "Traceback" not in stderr
    assert contents(folder) == before


REPLACED = (
    "run scene.toml -o run.nc",
    "study study.toml -o study.nc --csv study.csv",
    "motion record.AT2 --csv motion.csv --picture motion.png",
    pytest.param("plot run.nc -o run.svg", marks=pytest.mark.wide),
    pytest.param("plot run.nc -o run.pdf", marks=pytest.mark.wide),
    "report run.nc --no-certificate -o run.html",
    "run scene.toml -o mine.nc --overwrite",
    "study study.toml --csv mine.csv --overwrite",
    pytest.param(
        "motion record.AT2 --csv mine.csv --picture mine.png --overwrite", marks=pytest.mark.long
    ),
    pytest.param("report run.nc --no-certificate -o mine.html --overwrite", marks=pytest.mark.long),
)


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize("words", REPLACED)
def test_commands_replace_own_files_and_others_on_request(words, folder):
    for ending in ("nc", "csv", "png", "html"):
        Path(f"mine.{ending}").write_text("mine")
    arguments = words.split()
    named = [
        arguments[k + 1] for k, word in enumerate(arguments) if word in ("-o", "--csv", "--picture")
    ]
    for name in named:
        os.utime(name, (0, 0))
        Path(name).chmod(0o640)
    assert main(arguments) == 0
    for name in named:
        assert Path(name).stat().st_mtime > 0
        assert Path(name).stat().st_mode & 0o777 == 0o640
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_functions_do_not_replace_foreign_files(folder):
    write_foreign_files()
    run = xr.open_dataset("run.nc")
    moving = rf.plot.animation(run, frames_per_second=2)
    record, odd = rf.GroundMotion.read("record.AT2"), xr.open_dataset("odd.html")
    Path("mine.AT2").write_text("mine")
    Path("mine.gif").write_text("mine")
    before = contents(folder)
    for write, arguments, words in (
        (rf.report, (run, "run.nc"), "ends in .html"),
        (rf.report, (run, "mine.html"), "not a report that rockframe wrote"),
        (rf.report, (run, "none/r.html"), "there is no folder 'none'"),
        (rf.report, (run, "kept"), "this is a folder"),
        (rf.report, (run, 3), "expected the path of a file"),
        (rf.report, (run, "a\0.html"), "expected the path of a file"),
        (record.to_at2, ("mine.AT2",), "not an acceleration file that rockframe wrote"),
        (record.to_at2, ("record.txt",), "ends in .at2"),
        (record.scaled(2.0).to_at2, ("record.AT2",), "this file is an input"),
        (moving.save, ("mine.gif",), "not an animation"),
        (moving.save, ("run.html",), "not a player"),
        (run.rockframe.player, ("run.html",), "not a player"),
    ):
        with pytest.raises(FileError, match=words):
            write(*arguments)
    for write, arguments in (
        (rf.report, (odd, "odd.html")),
        (record.scaled(2.0).to_at2, ("record.AT2",)),
    ):
        with pytest.raises(FileError, match="this file is an input"):
            write(*arguments, overwrite=True)
    assert contents(folder) == before
    run.close()
    odd.close()
    moving.save("run.gif", dpi=20)
    moving.save("moving.html")
    moving.save("mine.gif", dpi=20, overwrite=True)
    assert Path("mine.gif").read_bytes().startswith(b"GIF89a")
    record.to_at2("record.AT2")  # the same bytes
    record.scaled(2.0).to_at2("kept/twice.AT2")
    record.scaled(3.0).to_at2("kept/twice.AT2")
    assert rf.GroundMotion.read("kept/twice.AT2").si.horizontal.peak == pytest.approx(
        3 * record.si.horizontal.peak
    )
    mpl.pyplot.close("all")


def test_letters_that_cannot_be_written_are_replaced(folder):
    title = "citt\udce0"
    rf.report(xr.open_dataset(folder / "run.nc"), "title.html", title=title, certify=False)
    rf.plot.player(xr.open_dataset(folder / "run.nc"), title=title).save("player.html")
    for name in ("title.html", "player.html"):
        assert "citt?" in Path(name).read_text(encoding="utf-8")


def test_file_is_written_completely_or_left_unchanged(tmp_path):
    kind = FileKind.marked("a text", (".txt",), "by rockframe")
    path = tmp_path / "x.txt"
    link = tmp_path / "link.txt"
    link.symlink_to(path)
    assert write_file(link, kind, b"by rockframe") == link
    assert link.is_symlink()
    assert path.read_bytes() == b"by rockframe"

    def half(part):
        part.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(FileError, match=r"x\.txt: it cannot be written \(No space left"):
        write_file(path, kind, half)
    assert path.read_bytes() == b"by rockframe"
    assert sorted(tmp_path.iterdir()) == [link, path]


@pytest.mark.parametrize("output", ["new.nc", "-"])
def test_netcdf_that_does_not_fit_on_the_disk_is_reported(folder, output, capsys):
    resource = pytest.importorskip("resource", reason="limits as of Unix")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    try:
        assert main(["run", "scene.toml", "-o", output]) == 2
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "cannot be written (NetCDF: HDF error); the disk may be full" in capsys.readouterr().err
    assert not [*folder.glob("*new.nc"), *folder.glob(".*.nc")]


@pytest.mark.parametrize(
    "closed",
    [pytest.param("|head", marks=pytest.mark.long), pytest.param("full", marks=pytest.mark.wide)],
)
def test_output_file_survives_closed_or_full_stdout(closed, folder):
    words = [sys.executable, "-m", "rockframe", "run", "scene.toml", "-o", "new.nc"]
    reader, writer = os.pipe()
    os.close(reader)  # the reader has closed before anything is printed
    with open(os.devnull if closed == "|head" else "/dev/full", "w") as full:
        done = subprocess.run(
            words, stdout=writer if closed == "|head" else full, stderr=subprocess.PIPE, text=True,
            timeout=300, check=False, env=os.environ | {"ROCKFRAME_COMPILE": "0"},
        )  # fmt: skip
    os.close(writer)
    assert "Traceback" not in done.stderr
    assert "Error" not in done.stderr
    if closed == "full":
        assert (done.returncode, "the output cannot be written" in done.stderr) == (2, True)
    else:
        assert (done.returncode, done.stderr) == (0, "")
    with xr.open_dataset(folder / "new.nc") as stored:
        assert "verdict" in stored.attrs


WRITES = {"write_text", "write_bytes", "to_netcdf", "to_csv", "savefig", "savetxt", "save"}
OWN_WRITERS = {
    "writing.py": "the mechanism",
    "studies/sweeps/store.py": "the folder of a study, whole or not at all by itself",
    "studies/sweeps/claims.py": "claims in that folder, which one job alone can make",
    "compiled/store.py": "machine code, in a folder of its own",
    "command/shared.py": "to the place that the mechanism gives",
    "command/streams.py": "to the null device, in place of closed streams",
    "command/figures.py": "to memory, and by the methods of players and animations",
    "command/motions.py": "by the method of a motion",
    "reports/page.py": "to memory",
    "accessor.py": "by the method of a player",
    "export/_opensees_model.py": "copied into a file that runs elsewhere, beside which it writes",
    "plot/_animation.py": "to the place that the mechanism gives",
}
"""Modules that write, and why they may."""


def test_only_known_modules_write_files():
    """A function that writes uses `write_file`, or its module is listed above with a reason."""
    package = Path(rf.__file__).parent
    found = set()
    for file in package.rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        if not re.search(rf"\b({'|'.join(WRITES)}|open|write)\b", text):
            continue  # without such a call
        for node in ast.walk(ast.parse(text)):
            if not isinstance(node, ast.Call):
                continue
            modes = [one.value for one in node.args if isinstance(one, ast.Constant)]
            opens = getattr(node.func, "attr", getattr(node.func, "id", "")) == "open" and any(
                isinstance(mode, str) and set(mode) & set("wax") and len(mode) < 4 for mode in modes
            )
            trees = "ElementTree" in text and ast.unparse(node.func).endswith(
                "ElementTree(root).write"
            )
            if getattr(node.func, "attr", "") in WRITES or opens or trees:
                found.add(file.relative_to(package).as_posix())
    assert found == set(OWN_WRITERS)
