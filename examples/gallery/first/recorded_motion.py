"""
A bookcase in a recorded earthquake
===================================

San Francisco shook gently on 17 October 1989, 73 km from the fault of Loma Prieta. How many times
stronger could it have been before a bookcase fell?
"""

import rockframe as rf

motion = rf.GroundMotion.example("loma-prieta")
print(motion)

bookcase = rf.System(rf.Block(width="0.25 m", height="2 m", mass="60 kg"))
as_recorded = bookcase.simulate(motion, free_vibration="5 s")
print("As recorded:", as_recorded.attrs["verdict"])

# %%
# ``critical_scale`` multiplies the motion until the bookcase falls.

found = rf.critical_scale(bookcase, motion, largest=12.0, scales=60, free_vibration="5 s")
stands, falls = float(found.scale_below[0]), float(found.scale_above[0])
print(f"It falls at {falls:.2f} times the motion.")

# %%
# On both sides of that scale, which lie close together:

runs = {
    f"{scale:.4f} times": bookcase.simulate(motion.scaled(scale), free_vibration="5 s")
    for scale in (stands, falls)
}
rf.plot.response(runs, panels=("ground", "rotation"), rotation="deg")
