"""
Figure 13: R = 10 m, pads of frequency ratio 10
===============================================

Large blocks on soft pads. Brown lines: the rotation at which a corner leaves its pad; crosses: the
block overturns.
"""

import parametric_study

runs = parametric_study.study("10 m", frequency_ratio=10)
parametric_study.tell(runs)
parametric_study.draw(runs)
