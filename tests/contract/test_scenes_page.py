"""The page on random scenes agrees with the data of its command."""

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


def test_scenes_table_matches_data():
    rows_by_kind = {
        row["kind"]: row for row in json.loads((DOCS / "data/maximal_oracle.json").read_text())
    }
    rows = table("validation_scenes.md", HEAD)
    assert [row[0] for row in rows] == list(NAMES)
    for name, *cells in rows:
        expected = rows_by_kind[NAMES[name]]
        assert cells == [
            str(expected["scenes"]),
            str(expected["agrees"]),
            f"{expected['worst_agreeing']:.0e}".replace("e-0", "e-"),
            str(expected["chaos"]),
            str(expected["sensitive"] + expected["disagrees"]),
            str(expected["overturned"]),
            str(len(expected["verdicts_differ"])),
        ]
        assert expected["scenes"] >= 1000
        assert expected["disagrees"] == expected["sensitive"] == 0


LEVELS = (
    "| accuracy | scenes | agree | chaos | sensitive | by tolerance | else | other verdict | "
    "of these warned of | peak off by 5 % | of these warned of |"
)


def test_accuracy_table_matches_data():
    found = json.loads((DOCS / "data/maximal_oracle_levels.json").read_text())
    assert {(row["kind"], row["variant"]) for row in found} == {
        (kind, variant) for kind in NAMES.values() for variant in ("plain", "eccentric", "inclined")
    }
    rows = table("validation_scenes.md", LEVELS)
    assert [row[0] for row in rows] == ["tight", '`"standard"`', '`"fast"`']
    for name, *cells in rows:
        level_rows = [row for row in found if row["level"] == name.strip('`"')]
        counts = [
            sum(row[label] for row in level_rows)
            for label in ("scenes", "agrees", "chaos", "sensitive", "by tolerance")
        ]
        counts.append(sum(row["disagrees"] + row["apart"] for row in level_rows))
        counts += [
            sum(len(row[label]) for row in level_rows)
            for label in ("verdicts_differ", "verdicts_told", "peaks_far", "peaks_far_told")
        ]
        assert cells == [str(count) for count in counts]
        assert counts[0] >= 5000
        assert sum(row["disagrees"] for row in level_rows) == 0
        if name != '`"fast"`':
            assert counts[6] == 0


TIED = (
    "| bodies, tied | scenes | agree | median difference | largest difference | with uplift | "
    "overturn | events |"
)


def test_tied_stacks_table_matches_data():
    found = json.loads((DOCS / "data/chain_ties_oracle.json").read_text())
    rows = table("validation_scenes.md", TIED)
    for expected, row in zip(found, rows, strict=True):
        keys = ("bodies", "scenes", "agree", "uplifting", "overturning", "events")
        cells = [row[i] for i in (0, 1, 2, 5, 6, 7)]
        assert cells == [str(expected[key]) for key in keys]
        assert [float(row[3]), float(row[4])] == [expected["median"], expected["worst"]]


def test_second_seed_table_matches_data():
    rows_by_kind = {
        row["kind"]: row for row in json.loads((DOCS / "data/maximal_oracle_28.json").read_text())
    }
    rows = table("validation_scenes.md", HEAD.replace("| scene |", "| scene, seed 28 |"))
    assert [NAMES[row[0]] for row in rows] == list(rows_by_kind)
    for name, *cells in rows:
        expected = rows_by_kind[NAMES[name]]
        keys = ("scenes", "agrees", "chaos", "overturned")
        assert [cells[i] for i in (0, 1, 3, 5)] == [str(expected[key]) for key in keys]
        assert int(cells[4]) == expected["sensitive"] + expected["disagrees"]
        assert int(cells[6]) == len(expected["verdicts_differ"])
