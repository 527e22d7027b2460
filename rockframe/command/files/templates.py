"""Scenes and a study to begin with."""

from typing import Final

_MOTION: Final = """\
[motion]                         # or --motion record.AT2 on the command line
constructor = "sine_pulse"       # or file = "record.AT2"
amplitude = "{amplitude}"
frequency = "{frequency}"

[run]
free_vibration = "{free}"          # still ground after the motion
accuracy = "standard"            # or "fast", "reference"
"""

_BLOCK: Final = """\
# A block that stands freely on rigid ground.
# Every quantity carries its unit. 'rockframe template all' lists every key.

[block]
width = "0.8 m"                  # in the plane of rocking
height = "3.2 m"
mass = "5.5 t"

"""

_PADS: Final = """\
# A block on two viscoelastic pads, one under each corner.

[block]
width = "4.85 m"
height = "19.4 m"
mass = "600 t"

[pads]
frequency_ratio = 20             # or stiffness = "12 MN/m", of one pad
damping_ratio = 0.10             # or damping = "80 kN*s/m"

"""

_SOIL: Final = """\
# A block on soil, a bed of springs and dashpots that take no tension.

[block]
width = "4 m"
height = "18 m"
mass = "99 t"

[soil]
constructor = "from_subgrade_modulus"   # or stiffness = "80 MPa" alone
modulus = "20 MN/m^3"
depth = "4 m"                    # of the base, out of the plane of rocking
damping_ratio = 0.20

"""

_STACK: Final = """\
# A frame building on pads, on a cap, on soil.

[block]
type = "FrameEquivalent"         # the rigid block that rocks like the frame
width = "4 m"
height = "18 m"
mass = "99 t"
shape_factor = 2.92

[pads]
frequency_ratio = 40
damping_ratio = 0.10

[cap]
height = "0.9 m"
mass = "36 t"

[soil]
stiffness = "9 MPa"              # per length of base in the plane of rocking
damping_ratio = 0.20

[system]
coupling = "coupled"             # or "cascade", as in the paper

"""

_STUDY: Final = """\
# A study: a scene at all combinations of the values of its axes.

scene = "scene.toml"             # or the tables of the scene in this file
# motions = ["records/*.AT2"]    # files, folders and archives; else the scene's motion
# cases = "cases.csv"            # a table with a row for each case, instead of axes
store = "study"                  # a folder: an interrupted study goes on
output = "study.nc"

[axes]
scale = [0.5, 1.0, 1.5, 2.0]     # of the motion
width = ["0.7 m", "0.8 m", "0.9 m"]    # a parameter of the scene's parts

[sweep]
accuracy = "fast"
"""

TEMPLATES: Final = {
    "block": _BLOCK + _MOTION.format(amplitude="-5 m/s^2", frequency="2 Hz", free="5 s"),
    "pads": _PADS + _MOTION.format(amplitude="-9.81 m/s^2", frequency="1 Hz", free="5 s"),
    "soil": _SOIL + _MOTION.format(amplitude="-6 m/s^2", frequency="1 Hz", free="8 s"),
    "stack": _STACK + _MOTION.format(amplitude="-4 m/s^2", frequency="1 Hz", free="9 s"),
    "study": _STUDY,
}
"""Texts by what they describe."""
