"""
Figure 10: R = 5 m, pads of frequency ratio 10
==============================================

Blocks of medium size on soft pads. Brown lines: the rotation at which a corner leaves its pad;
crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("5 m", frequency_ratio=10)
parametric_study.tell(runs)
parametric_study.draw(runs)
