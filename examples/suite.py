"""A set of records: read, scaled to the spectrum of a code, and simulated.

Usage: python examples/suite.py [records] [--count 7] [--folder results]

`records` is a folder or an archive with records of both horizontal components. Without it a small
archive is synthesised: sixteen stations of an earthquake, in a zip file. Prints the set that fits
Eurocode 8 best and how often a cabinet overturns under it; writes selection.png, suite.nc and
runs.csv.
"""

import argparse
import io
import sys
import zipfile
from pathlib import Path

import rockframe as rf

STATIONS = 16


def synthetic_archive() -> bytes:
    """Pack accelerograms of sixteen stations, as a download would."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for station in range(STATIONS):
            distance = f"{8 + 2 * station} km"
            for place, component in enumerate(("000", "090")):
                motion = rf.GroundMotion.stochastic(6.8, distance, seed=2 * station + place)
                values = motion.acceleration.m_as("g_0")
                head = (
                    f"made up\nMade Up, 1/1/2020, Station {station + 1}, {component}\n"
                    f"ACCELERATION IN UNITS OF G\nNPTS= {values.size}, DT= .005 SEC\n"
                )
                lines = "\n".join(f"{value:.7e}" for value in values)
                archive.writestr(f"RSN{station + 1}_MADE_{component}.AT2", head + lines)
    return packed.getvalue()


def main() -> int:
    """Read the arguments and run; print errors in one line."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("records", nargs="?", help="folder or archive; synthetic if none")
    parser.add_argument("--count", type=int, default=7, help="records to choose")
    parser.add_argument("--folder", default=".", help="where the results are written")
    arguments = parser.parse_args()
    try:
        folder = Path(arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        select_and_simulate(arguments.records, arguments.count, folder)
    except (rf.errors.RockframeError, OSError) as problem:
        print(f"suite: {' '.join(str(problem).split())}", file=sys.stderr)
        return 1
    return 0


def select_and_simulate(records: str | None, count: int, folder: Path) -> None:
    """Read a suite, select motions by their spectra, and simulate a cabinet."""
    suite = rf.read_suite(records or synthetic_archive())
    print(
        f"{len(suite)} motions, {len(suite.pairs)} of both components, {len(suite.unread)} not read"
    )

    target = rf.TargetSpectrum.eurocode_8("0.3 g_0", "B")
    found = suite.selection_for(target, count, combination="RotD50")
    print(f"Closest to {target.name}: misfit of the set {float(found.set_misfit):.3f}")
    for record in found["motion"].to_numpy():
        row = found.sel(motion=record)
        factor, misfit = float(row.scale_factor), float(row.spectral_misfit)
        print(f"  {record:8} times {factor:.2f}, misfit {misfit:.2f}")
    chosen = suite.scaled_to(found)

    cabinet = rf.System(rf.Block(width="0.3 m", height="2 m", mass="200 kg"))
    runs = rf.concat(
        [cabinet.simulate(motion, outputs=None) for motion in chosen.values()],
        "motion",
        list(chosen),
    )
    overturned = int(runs.overturned.sum())
    print(f"A cabinet 2 m high and 0.3 m deep falls under {overturned} of {len(chosen)} motions.")

    rf.plot.selection(found).figure.savefig(folder / "selection.png", dpi=150)
    chosen.to_dataset().to_netcdf(folder / "suite.nc")
    rf.table(runs).to_csv(folder / "runs.csv")
    print(f"Written: {folder / 'selection.png'}, {folder / 'suite.nc'}, {folder / 'runs.csv'}")


if __name__ == "__main__":
    sys.exit(main())
