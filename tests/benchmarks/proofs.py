"""Proved verdicts of random blocks under recorded motions, against runs and 50-digit runs.

Run as ``python tests/benchmarks/proofs.py`` with the repository on the path and the records of
tests/records.py available; writes docs/data/proofs.json. With ``--sets 50`` it proves sets of
numbers about the first fifty blocks instead, and writes docs/data/proof_sets.json.
"""

import argparse
import json
import math
import sys
import time
from collections import Counter
from pathlib import Path

import mpmath
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests")]

from records import records_folder  # noqa: E402
from reference_models.fifty_digits import ExactRun  # noqa: E402

import rockframe as rf  # noqa: E402
from rockframe.proof.balls import ball  # noqa: E402
from rockframe.proof.rocking import prove_block  # noqa: E402

SEED = 31
RECORDS = {
    "El Centro 1940": ("ElCentro1940_Peknold.AT2", None),
    "El Centro 1940, array 9": ("PEERSMD_IMPVALL_IELC180.AT2", None),
    "Nishi-Akashi 1995": ("NIS090.AT2", None),
    "Gilroy 1989": ("RSN763_LOMAP_GIL067.AT2", None),
    "San Francisco 1989": ("SMC_LomaPrieta1989_0111a.smc", None),
    "TCU128 1999": ("PEERSMD_CHICHI_TCU128-N.AT2", None),
    "TCU128 1999, 090": ("SLAMMER_CHICHI_TCU128-090.txt", None),
    "Wairakei 2018": ("GEONET_20180212_211557_WPWS_20.V2A", "S74E"),
    "Hualien 2018": ("CWA_20180206_1-EAS.dat", "E"),
    "Greece 2019": ("ESM_HI.ARS1..HNE.D.20190728.160908.C.ACC.ASC", None),
}
LONGEST = 20.0  # of a record, about its peak [s]
STRONGEST = (1.0, 8.0)  # peaks, over that of uplift
GRAVITY = 9.81
AFTER = "15 s"
SETS = ((1e-12, 1), (1e-12, 8), (1e-9, 1), (1e-9, 8), (1e-6, 1))  # tolerance, most parts


def records():
    """Return the strong part of each record, unfiltered."""
    parts = {}
    for name, (file, component) in RECORDS.items():
        bare = {"time_step": "0.005 s", "unit": "g"} if file.endswith(".txt") else {}
        motion = rf.GroundMotion.read(records_folder() / file, component=component, **bare)
        samples = motion.si.horizontal.samples
        step = motion.si.time_step
        middle, half = int(np.argmax(np.abs(samples))), round(LONGEST / 2 / step)
        part = samples[max(0, middle - half) : middle + half]
        parts[name] = (part - part[0]) / np.abs(part - part[0]).max(), step
    return parts


def draw_case(k, all_records):
    """Draw a block and its motion; every third block is eccentric, every fifth on a slope."""
    rng = np.random.default_rng([SEED, k])
    name = list(all_records)[k % len(all_records)]
    radius, slenderness = np.exp(rng.uniform(np.log(0.4), np.log(8.0))), rng.uniform(2.5, 8.0)
    width = 2.0 * radius / np.hypot(1.0, slenderness)
    height = slenderness * width
    away = rng.uniform(-0.08, 0.08) * width if k % 3 == 0 else 0.0
    block = rf.Block(
        width=f"{width} m", height=f"{height} m", mass="1 t",
        centre_of_mass=(f"{height / 2} m", f"{away} m"),
    )  # fmt: skip
    slope = {"inclination": f"{rng.uniform(-0.02, 0.02)} rad"} if k % 5 == 0 else {}
    scene = rf.System(block, gravity=f"{GRAVITY} m/s^2", **slope)
    shape, step = all_records[name]
    peak = GRAVITY / slenderness * np.exp(rng.uniform(*np.log(STRONGEST)))
    across = np.round(peak * shape, 9)
    vertical = {}
    if k % 4 == 0:
        vertical = {"vertical": (np.round(0.4 * across[::-1], 9), "m/s^2")}
    return name, scene, rf.GroundMotion.from_arrays((across, "m/s^2"), f"{step} s", **vertical)


def compare_with_run(scene, motion, proof):
    """Return whether the most accurate run has another verdict, and the difference of its time."""
    run = scene.simulate(motion, free_vibration=AFTER, accuracy="reference", outputs=None)
    falls, end = bool(run.overturned), float(run.attrs["solver_end_time"])
    apart = math.nan
    if falls and proof.overturns:
        apart = abs(float(run.overturning_time) - proof.earliest)
    return proof.decided and not proof.agrees(falls, end), apart


def count_outside_fifty_digits(scene, motion, proof):
    """Count the samples at which the run with fifty digits is outside of its enclosure."""
    assembly, boxes = scene.assembly, {}

    def watch(number, after, side, box):
        if after.is_zero() and number <= motion.si.horizontal.samples.size - 1:
            boxes[number] = side, box

    prove_block(
        assembly.model.system, motion.si, assembly.options.slope,
        assembly.setting.overturning_angles, (0.0, 0.0), callback=watch,
    )  # fmt: skip
    vertical = None if motion.si.vertical is None else motion.si.vertical.samples
    # up to rest, which the 50-digit run never reaches
    moving = [number for number, (side, _) in boxes.items() if side]
    rests = [n for n, (side, _) in boxes.items() if side == 0 and n > min(moving, default=n)]
    until = max((n for n in boxes if n < min(rests, default=n + 1)), default=0)
    exact = ExactRun(
        assembly.model.system, motion.si.horizontal.samples, vertical, motion.si.time_step,
        degree=22, until=until,
    ).run()  # fmt: skip
    out = 0
    with mpmath.workdps(50):
        for number, (side, box) in boxes.items():
            if number >= len(exact.states):
                continue
            same = side == exact.sides[number] or not any(exact.states[number])
            pairs = zip(box, exact.states[number], strict=True)
            held = side == 0 or all(
                one.overlaps(ball(mpmath.nstr(value, 45))) for one, value in pairs
            )
            out += not (same and held)
    return out, len(exact.states)


def campaign(count, exact):
    """Prove, run and compare."""
    every = records()
    verdicts, causes, contradictions, seconds, widths = Counter(), Counter(), [], [], []
    bits, samples, outside, instants = Counter(), 0, [], []
    of_record = {name: Counter() for name in every}
    level = [k for k in range(count) if k % 5]
    chosen = set(level[:: max(1, len(level) // exact)][:exact])
    for k in range(count):
        name, scene, motion = draw_case(k, every)
        start = time.process_time()
        proof = rf.prove(scene, motion)
        seconds.append(time.process_time() - start)
        verdicts[proof.verdict] += 1
        of_record[name][proof.verdict] += 1
        bits[str(proof.bits)] += 1
        if proof.decided:
            widths.append(proof.width)
        else:
            causes[proof.reason] += 1
        otherwise, apart = compare_with_run(scene, motion, proof)
        contradictions += [k] if otherwise else []
        instants.append(apart)
        if k in chosen:
            wrong, there = count_outside_fifty_digits(scene, motion, proof)
            samples += there
            outside += [k] if wrong else []
        print(k, name, proof.verdict, proof.reason, f"{seconds[-1]:.2f}", flush=True)
    return {
        "seed": SEED,
        "blocks": count,
        "records": {name: dict(counts) for name, counts in of_record.items()},
        "verdicts": dict(verdicts),
        "undecided by cause": dict(causes),
        "contradicted by reference": contradictions,
        "instants of overturning by reference are off by [s]": {
            "median": float(f"{np.nanmedian(instants):.2g}"),
            "worst": float(f"{np.nanmax(instants):.2g}"),
        },
        "bits": dict(bits),
        "greatest width": float(f"{max(widths):.2g}"),
        "median width": float(f"{np.median(widths):.2g}"),
        "seconds": {
            "median": float(f"{np.median(seconds):.2g}"),
            "90 of 100": float(f"{np.quantile(seconds, 0.9):.2g}"),
            "worst": float(f"{max(seconds):.2g}"),
        },
        "fifty digits": {"blocks": len(chosen), "samples": samples, "outside": outside},
    }


def sets(count):
    """Prove all restitutions, scales and angles within tolerances about blocks, in parts."""
    all_records, results = records(), {}
    for tolerance, parts in SETS:
        seconds, causes, verdicts, shares, wrong = [], Counter(), Counter(), [], []
        for k in range(count):
            _, scene, motion = draw_case(k, all_records)
            start = time.process_time()
            proof = rf.prove(
                scene, motion, parts=parts, restitution_tolerance=tolerance,
                scale_tolerance=tolerance, angle_tolerance=f"{tolerance} rad",
            )  # fmt: skip
            seconds.append(time.process_time() - start)
            verdicts[proof.verdict] += 1
            shares.append(proof.safe_share + proof.overturning_share)
            if not proof.decided:
                causes[proof.reason.split(", in the")[0]] += 1
                continue
            for scale in (1.0 - 0.99 * tolerance, 1.0 + 0.99 * tolerance):
                otherwise, _ = compare_with_run(scene, motion.scaled(scale), proof)
                wrong += [k] if otherwise else []
        which = f"within {tolerance:g}, at most {parts} parts"
        results[which] = {
            "verdicts": dict(verdicts),
            "mean share decided": float(f"{np.mean(shares):.3f}"),
            "undecided by cause": dict(causes),
            "contradicted by reference": wrong,
            "median seconds": float(f"{np.median(seconds):.2g}"),
            "greatest seconds": float(f"{max(seconds):.2g}"),
        }
        print(which, results[which], flush=True)
    return {"seed": SEED, "blocks": count, "sets": results}


if __name__ == "__main__":
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--count", type=int, default=300)
    asked.add_argument("--exact", type=int, default=30)
    asked.add_argument("--sets", type=int, default=0)
    asked.add_argument("--output", type=Path)
    given = asked.parse_args()
    found = sets(given.sets) if given.sets else campaign(given.count, given.exact)
    file = "proof_sets.json" if given.sets else "proofs.json"
    output = given.output or ROOT / "docs" / "data" / file
    output.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
