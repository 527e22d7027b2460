"""The members of a six-storey frame, and the properties that follow from them.

Usage: python examples/frame_members.py [--folder results]

Prints the members by kind, shape factor and space proportion, beside the values of the
paper's Table 2, and writes frame_members.nc, the table of all members.
"""

import argparse
from pathlib import Path

import rockframe as rf


def main() -> None:
    """Build the frame, print its members and properties, and write the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("--folder", default=".", help="where the table is written")
    arguments = parser.parse_args()

    frame = rf.FrameEquivalent.from_members(
        storeys=6,
        height="18 m",
        width="4 m",
        column_width="0.35 m",
        beam_height="0.30 m",
        beam_width="0.25 m",
        density="2500 kg/m^3",
    )
    table = frame.members_table()
    by_kind = table[["mass", "volume", "inertia_about_middle"]].groupby("kind").sum()
    by_kind["shape_factor"] = (
        by_kind.mass * frame.radius.m_as("m") ** 2 / by_kind.inertia_about_middle
    )
    print(by_kind.to_dataframe().round(3).to_string(), end="\n\n")

    print(f"{'':24}{'members':>10}{'Table 2':>10}")
    rows = (
        ("mass [t]", frame.mass.m_as("t"), 99.0),
        ("shape factor mu", frame.shape_factor, 0.380),
        ("space proportion chi", frame.space_proportion, 0.138),
        ("overturning angle [rad]", frame.overturning_angle.m_as("rad"), 0.219),
    )
    for name, computed, published in rows:
        print(f"{name:24}{computed:10.3f}{published:10.3f}")
    share = frame.centre_of_mass_height / frame.height
    print(f"The centre of mass lies at {share.m_as(''):.3f} of the height.")

    folder = Path(arguments.folder)
    folder.mkdir(parents=True, exist_ok=True)
    table.to_netcdf(folder / "frame_members.nc")
    print(f"Members: {folder / 'frame_members.nc'}")


if __name__ == "__main__":
    main()
