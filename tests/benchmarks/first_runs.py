"""Times of the first run of a kind of scene: after compilation, without it, and later.

Prints, for each kind of scene, the time of `simulate` in a new process, under half a minute of
record, with nothing stored and ``ROCKFRAME_COMPILE=wait``; with nothing stored; with the machine
code of another kind, of pads or, for pads, of soil; and with its own. ::

    python tests/benchmarks/first_runs.py
"""

import os
import subprocess
import sys
import tempfile

RUN = """
import sys, time
import rockframe as rf
from rockframe.compiled import parallel
block = rf.Block(width="1 m", height="4 m", mass="10 t")
pads = rf.TwoSpringSupport(stiffness="20 MN/m", damping_ratio=0.1)
cap = rf.CushionCap(height="0.5 m", mass="5 t")
soil = rf.WinklerSoil(stiffness="9 MPa", damping_ratio=0.1)
upper = rf.Block(width="0.8 m", height="2 m", mass="4 t")
parts = {
    "rigid ground": (block,), "pads": (block, pads), "soil": (block, soil),
    "coupled": (block, pads, cap, soil),
    "cascade": (block, pads, cap, soil),
    "stack": (rf.Stack(upper, block, interfaces=[pads]), pads),
}
name, accuracy = sys.argv[1:]
options = {"coupling": "cascade"} if name == "cascade" else {}
system = rf.System(*parts[name], **options)
record = rf.GroundMotion.example("loma-prieta").scaled(1.5)
begun = time.perf_counter()
system.simulate(record, accuracy=accuracy)
print(time.perf_counter() - begun)
for compiler in parallel._compilers:  # lest it slows the next process down
    compiler.wait()
"""
SCENES = ("rigid ground", "pads", "soil", "coupled", "cascade", "stack")


def time_of(scene: str, accuracy: str, folder: str, how: str) -> float:
    """Return the time of the first run of a process [s]."""
    environment = os.environ | {"ROCKFRAME_CACHE_DIR": folder, "ROCKFRAME_COMPILE": how}
    done = subprocess.run(
        [sys.executable, "-c", RUN, scene, accuracy], env=environment, check=True, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    return float(done.stdout)


def main() -> None:
    """Print the table."""
    print("scene          accuracy   waiting  at once     next    later  [s]")
    for accuracy in ("standard", "fast"):
        for scene in SCENES:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                waiting = time_of(scene, accuracy, folder, "wait")
                later = min(time_of(scene, accuracy, folder, "1") for _ in range(3))
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                at_once = time_of(scene, accuracy, folder, "1")
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                time_of("soil" if scene == "pads" else "pads", accuracy, folder, "often")
                after = time_of(scene, accuracy, folder, "1")
            print(
                f"{scene:14} {accuracy:9} {waiting:8.2f} {at_once:8.2f} {after:8.2f} {later:8.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
