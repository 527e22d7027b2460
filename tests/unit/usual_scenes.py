"""The usual scenes, from parts that a test may change."""

import rockframe as rf


def block(**changed):
    return rf.Block(**{"width": "2 m", "height": "8 m", "mass": "50 t", **changed})


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 20, "damping_ratio": 0.1, **changed})


def cap(**changed):
    return rf.CushionCap(**{"height": "0.4 m", "mass": "20 t", "width": "2.5 m", **changed})


def soil(**changed):
    return rf.WinklerSoil(**{"stiffness": "9 MPa", "damping_ratio": 0.2, **changed})


def pulse():
    return rf.GroundMotion.sine_pulse("-3 m/s^2")


SCENES = {
    "rigid ground": (block(),),
    "rigid ground by name": (block(), rf.RigidGround()),
    "two-spring": (block(), pads()),
    "Winkler": (block(), soil()),
    "Winkler with a cap": (block(), cap(), soil()),
    "coupled": (block(), pads(), cap(), soil()),
    "cascade": (block(), pads(), cap(), soil()),
}


OPTIONS = {"cascade": {"coupling": "cascade"}}


def assembled(name, *others, **options):
    return rf.System(*SCENES[name], *others, **OPTIONS.get(name, {}), **options)
