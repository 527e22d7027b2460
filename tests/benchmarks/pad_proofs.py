"""Prove verdicts of random blocks on pads under recorded motions; compare with reference runs.

``python tests/benchmarks/pad_proofs.py 100`` writes docs/data/pad_proofs.json. Twelve
seconds about the peak of each record are used, so that a hundred scenes take some minutes.
"""

import json
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import rockframe as rf

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.records import record_path  # noqa: E402

RECORDS = (
    "ElCentro1940_Peknold.AT2",
    "PEERSMD_IMPVALL_IELC180.AT2",
    "NIS090.AT2",
    "RSN763_LOMAP_GIL067.AT2",
    "PEERSMD_CHICHI_TCU128-N.AT2",
)
KINDS = (("centre", "small"), ("centre", "finite"), ("contact-state", "finite"))
WRITTEN = ROOT / "docs" / "data" / "pad_proofs.json"


def motions() -> list[rf.GroundMotion]:
    """Return the strong parts, each scaled to 0.4 g."""
    motions_found = []
    for name in RECORDS:
        record = rf.GroundMotion.read(record_path(name))
        signal = record.si.horizontal.samples
        peak = float(np.argmax(np.abs(signal))) * record.si.time_step
        end = min(peak + 7.0, (signal.size - 1) * record.si.time_step)
        part = record.window(f"{max(peak - 5.0, 0.0):.2f} s", f"{end:.2f} s")
        motions_found.append(part.scaled(0.4 * 9.80665 / float(np.abs(signal).max())))
    return motions_found


def main(count: int) -> None:
    """Prove, run, compare and write."""
    rng, all_motions, rows = np.random.default_rng(31), motions(), []
    for i in range(count):
        block = rf.Block.from_size(
            radius=f"{rng.uniform(0.5, 5.0):.4f} m", slenderness=round(rng.uniform(2.0, 7.0), 3),
            mass="1 t",
        )  # fmt: skip
        pads = rf.TwoSpringSupport(
            frequency_ratio=round(rng.uniform(8.0, 40.0), 3),
            damping_ratio=round(rng.uniform(0.05, 0.4), 3),
        )
        restraint, rotation = KINDS[i % len(KINDS)]
        system = rf.System(block, pads, restraint=restraint, rotation=rotation)
        motion, scale = all_motions[i % len(RECORDS)], round(rng.uniform(0.5, 2.5), 4)
        begin = time.process_time()
        proof = rf.prove(system, motion, scale=scale)
        taken = time.process_time() - begin
        run = system.simulate(motion.scaled(scale), duration="90 s", accuracy="reference")
        overturned = bool(run.overturned)
        at = float(run.overturning_time) if overturned else None
        agrees = None
        if proof.decided:
            agrees = proof.overturns == overturned
            if at is not None:
                agrees &= abs(at - proof.earliest) < 1e-6
        rows.append(
            {
                "motion": RECORDS[i % len(RECORDS)], "restraint": restraint, "rotation": rotation,
                "verdict": proof.verdict, "reason": proof.reason, "impacts": proof.impacts,
                "width": proof.width, "bits": proof.bits, "seconds": round(taken, 2),
                "earliest": proof.earliest if proof.overturns else None, "reference": at,
                "agrees": agrees,
            }
        )  # fmt: skip
        print(i, rows[-1], flush=True)
        seconds = [one["seconds"] for one in rows]
        summary = {
            "scenes": len(rows),
            "verdicts": Counter(one["verdict"] for one in rows),
            "undecided": Counter(one["reason"] for one in rows if one["reason"]),
            "contradictions": sum(one["agrees"] is False for one in rows),
            "median_seconds": float(np.median(seconds)),
            "longest_seconds": max(seconds),
            "widest": max(one["width"] for one in rows if one["verdict"] != "undecided"),
        }
        WRITTEN.write_text(json.dumps({"summary": summary, "scenes": rows}, indent=1) + "\n")
    print(json.dumps(summary, indent=1))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
