"""Print, from the stored measurements, the tables of the manual's page on speed."""

import json
from pathlib import Path

import numpy as np

DATA = Path(__file__).parents[2] / "docs" / "data"
WANTED = (1e-2, 1e-4, 1e-6, 1e-8)
ALIKE = 1e-11
"""Error below which points count as equally accurate, near that of the reference."""


def fastest(points: list[dict], program: str, wanted: float) -> dict | None:
    """Return the fastest run of a program with at most a given error."""
    good = [
        one
        for one in points
        if one["program"] == program
        and one["error"] is not None
        and one["error"] <= max(wanted, ALIKE)
    ]
    return min(good, key=lambda one: one["time"]) if good else None


def least_ratio(points: list[dict], program: str) -> float:
    """Return the least ratio of a program's time to rockframe's at its error or better."""
    ratios = []
    for one in points:
        if one["program"] != program or one["error"] is None:
            continue
        ours = fastest(points, "rockframe", one["error"])
        if ours is not None:
            ratios.append(one["time"] / ours["time"])
    return min(ratios)


def beaten(points: list[dict], program: str) -> bool:
    """Whether for each point of a program one of rockframe is as accurate and faster."""
    return all(
        (ours := fastest(points, "rockframe", one["error"])) is not None
        and ours["time"] < one["time"]
        for one in points
        if one["program"] == program and one["error"] is not None and np.isfinite(one["error"])
    )


def work_precision() -> None:
    """Print times at given errors, and the least ratios."""
    data = json.loads((DATA / "work_precision.json").read_text())
    print(data["machine"])
    print("stepping alone", data.get("stepping_alone"))
    rows = {name: (scene["points"], "SciPy") for name, scene in data["scenes"].items()}
    rows["OpenSees"] = (data["opensees"]["undamped, with uplift"]["points"], "OpenSees")
    for name, (points, program) in rows.items():
        print(f"\n{name}: least ratio {least_ratio(points, program):.0f}, "
              f"beaten at every error: {beaten(points, program)}")  # fmt: skip
        for level in ("fast", "standard", "reference"):
            one = next(one for one in points if one["setting"] == level)
            print(
                f"  {level}: {1e3 * one['time']:.1f} ms, {one['error']:.0e}, {one['steps']} steps"
            )
        for wanted in WANTED:
            other, ours = (fastest(points, which, wanted) for which in (program, "rockframe"))
            if other is None:
                print(f"  {wanted:g}: never")
                continue
            print(f"  {wanted:g}: {other['time']:.3g} s ({other.get('method', '')} "
                  f"{other.get('way', '')} {other['setting']}), "
                  f"ratio {other['time'] / ours['time']:.0f}")  # fmt: skip


def cost_model() -> None:
    """Print the constants of the cost model."""
    data = json.loads((DATA / "cost_model.json").read_text())
    for name, rows in data["lengths"].items():
        together = rows + data["impacts"][name]
        made = np.array([one["steps"] + one["rejected"] for one in together], dtype=float)
        times = np.array([one["time"] for one in together])
        matrix = np.stack([np.ones_like(made), made], axis=1) / times[:, None]
        (begin, per_step), *_ = np.linalg.lstsq(matrix, np.ones_like(times))
        worst = np.abs((begin + per_step * made) / times - 1.0).max()
        last = rows[-1]
        steps = last["steps"] / last["samples"]
        print(f"{name}: {1e3 * begin:.1f} ms + {1e9 * per_step:.0f} ns a step (within "
              f"{100 * worst:.0f} %); {steps:.2f} steps a sample, an hour in "
              f"{last['time']:.2f} s")  # fmt: skip
    for key in ("stiffness", "damping", "limits"):
        for one in data[key]:
            made = one["steps"] + one["rejected"]
            print(key, one["block"], one["level"], one.get("steps_per_period", ""),
                  one["frequency_ratio"], one["damping_ratio"], f"{1e3 * one['time']:.1f} ms,",
                  made, "steps, over those of stability",
                  f"{made / one['stable_steps']:.2f}")  # fmt: skip


if __name__ == "__main__":
    work_precision()
    cost_model()
