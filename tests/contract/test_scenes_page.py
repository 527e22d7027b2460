"""The page on random scenes, against what its command found."""

import json

from pages import DOCS, table

HEAD = "| scene | scenes | agree | worst of these | chaos | else | overturned | other verdict |"
NAMES = {
    "rigid ground": "rigid",
    "two pads": "pads",
    "soil": "bed",
    "cascade": "cascade",
    "coupled": "coupled",
}


def test_the_table_is_that_of_the_command():
    found = {
        row["kind"]: row for row in json.loads((DOCS / "data/maximal_oracle.json").read_text())
    }
    rows = table("validation_scenes.md", HEAD)
    assert [row[0] for row in rows] == list(NAMES)
    for name, *cells in rows:
        one = found[NAMES[name]]
        assert cells == [
            str(one["scenes"]),
            str(one["agrees"]),
            f"{one['worst_agreeing']:.0e}".replace("e-0", "e-"),
            str(one["chaos"]),
            str(one["sensitive"] + one["disagrees"]),
            str(one["overturned"]),
            str(len(one["verdicts_differ"])),
        ]
        assert one["scenes"] >= 1000
        assert one["disagrees"] == one["sensitive"] == 0
