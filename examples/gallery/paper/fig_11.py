"""
Figure 11: R = 5 m, pads of frequency ratio 20
==============================================

Blocks of medium size on pads of medium stiffness. Brown lines: the rotation at which a corner
leaves its pad; crosses: the block overturns.
"""

import parametric_study

import rockframe as rf

runs = parametric_study.study("5 m", frequency_ratio=20)
parametric_study.tell(runs)
parametric_study.draw(runs)

# %%
# The text adds that the block of H/B = 6 in this figure may overturn after the end of the pulse.
# On pads it overturns in its first swing, with every damping ratio; on rigid ground it does what
# the paper says.

rigid = rf.System(
    rf.Block.from_size(radius="5 m", slenderness=6, mass="1 t"), gravity="9.81 m/s^2"
).simulate(parametric_study.PULSE, duration="10 s", outputs=None)
print(f"On pads at {runs.overturning_time.sel(slenderness=6).min():.2f} s,", end=" ")
print(f"on rigid ground at {float(rigid.overturning_time):.2f} s.")
