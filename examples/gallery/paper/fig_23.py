"""
Figure 23: vertical displacement of the frames under TCU128
===========================================================

The text: stiffer pads reduce the vertical displacement. Here they do so for three storeys, coupled.
Six storeys rise more on stiffer pads, coupled, as more of their rocking is then uplift; by cascade
they rise most on those in the middle.
"""

import shaken

found = shaken.runs()
shaken.tell(found, lambda run: f"{1e3 * float(abs(run.vertical_displacement).max()):.1f} mm")
shaken.draw(found, "vertical_displacement", 1e3, "vertical [mm]")
