"""
Figure 9: R = 1 m, pads of frequency ratio 40
=============================================

Small blocks on stiff pads. The squat block bounces: it leaves both pads, which the paper asks to
avoid. Brown lines: the rotation at which a corner leaves its pad; crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("1 m", frequency_ratio=40)
parametric_study.tell(runs)
parametric_study.draw(runs)
