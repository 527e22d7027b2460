"""
Figure 8: R = 1 m, pads of frequency ratio 20
=============================================

Small blocks on pads of medium stiffness. Brown lines: the rotation at which a corner leaves its
pad; crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("1 m", frequency_ratio=20)
parametric_study.tell(runs)
parametric_study.draw(runs)
