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
as_recorded = bookcase.simulate(motion)
print("As recorded:", as_recorded.attrs["verdict"])

# %%
# ``critical_scale`` multiplies the motion until the bookcase falls.

found = rf.critical_scale(bookcase, motion, largest=12.0, scales=60, free_vibration="5 s")
factor = float(found.critical_scale)
print(f"It falls at {factor:.2f} times the motion.")

# %%
# A little below that scale, and just above it:

runs = {
    name: bookcase.simulate(motion.scaled(share * factor), free_vibration="5 s")
    for name, share in (("2 % less", 0.98), ("0.1 % more", 1.001))
}
rf.plot.response(runs, panels=("ground", "rotation"), rotation="deg")
