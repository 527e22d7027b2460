"""
Figure 7: R = 1 m, pads of frequency ratio 10
=============================================

Small blocks on soft pads: the more slender two overturn while the ground still shakes. Brown
lines: the rotation at which a corner leaves its pad; crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("1 m", frequency_ratio=10)
parametric_study.tell(runs)
parametric_study.draw(runs)
