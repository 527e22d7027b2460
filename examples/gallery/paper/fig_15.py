"""
Figure 15: R = 10 m, pads of frequency ratio 40
===============================================

Large blocks on stiff pads, which overturn least of the three sizes. Brown lines: the rotation at
which a corner leaves its pad; crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("10 m", frequency_ratio=40)
parametric_study.tell(runs)
parametric_study.draw(runs)
