"""
Figure 12: R = 5 m, pads of frequency ratio 40
==============================================

Blocks of medium size on stiff pads, which for this size are closest to rigid ground. Brown lines:
the rotation at which a corner leaves its pad; crosses: the block overturns.
"""

import parametric_study

runs = parametric_study.study("5 m", frequency_ratio=40)
parametric_study.tell(runs)
parametric_study.draw(runs)
