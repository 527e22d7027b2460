"""
Granite blocks on a shake table
===============================

248 tests of two blocks on a shake table. The result of a single test cannot be predicted; how often
a block overturns can be. Each dot shows the share of tests that overturned, of those for which an
ensemble of fitted blocks predicted about the same share. The fit for a test never used tests of the
same motion (:doc:`/validation_granite`).
"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rockframe

data = Path(rockframe.__file__).resolve().parents[1] / "docs" / "data" / "granite.json"
bins = json.loads(data.read_text())["ensemble"]
print("predicted   fell   of tests")
for one in bins:
    print(f"{one['predicted']:>9.0%} {one['fell']:>6} {one['tests']:>10}")

predicted, observed, low, high = (
    np.array([one[name] for one in bins]) for name in ("predicted", "observed", "low", "high")
)
figure, axes = plt.subplots(figsize=(5.0, 4.4), layout="constrained")
axes.plot([0.0, 1.0], [0.0, 1.0], "--", color="0.6", lw=0.9)
axes.errorbar(
    predicted, observed, (observed - low, high - observed), fmt="o", capsize=3, color="#0072b2"
)
axes.set(xlabel="predicted share that overturns", ylabel="share that overturned")
plt.show()
