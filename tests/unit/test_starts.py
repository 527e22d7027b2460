"""Where runs of two bodies start: as the coupled equations and a chain of the two say alike."""

import pytest

import rockframe as rf
from rockframe.dynamics.chain.model import chain_model
from rockframe.dynamics.protocol import Start

PADS = rf.TwoSpringSupport(frequency_ratio=20, damping_ratio=0.1)
SOIL = rf.WinklerSoil(stiffness="20 MPa", damping_ratio=0.2)
CAP = rf.CushionCap(width="2 m", height="0.5 m", mass="2 t")


@pytest.mark.parametrize("restraint", ["contact-state", "leading-corner"])
@pytest.mark.parametrize(
    "start",
    [
        Start(),
        Start(rotation=0.02),
        Start(rotation=-0.01, angular_velocity=0.1),
        Start(vertical_displacement=0.01, vertical_velocity=0.1),
        Start(angular_velocity=-0.2),  # a body at rest upright takes the side of the one above
    ],
)
def test_coupled_equations_and_chain_start_alike(restraint, start):
    block = rf.Block(width="1 m", height="4 m", mass="4 t")
    setting = rf.System(block, PADS, CAP, SOIL, restraint=restraint).assembly.setting
    models = setting.contact_model(), chain_model(setting.bodies(), setting.body.mass)
    starts = [(model, *model.initial(start)) for model in models]
    modes = [[model.system.body_mode(mode, k) for k in range(2)] for model, mode, *_ in starts]
    assert modes[0] == modes[1]
    (_, _, of_coupled, _), (_, _, of_chain, _) = starts
    n = [model.system.coordinates() for model in models]
    for i in range(4):  # rotations and vertical displacements, then their rates
        assert of_coupled[i] == of_chain[i]
        assert of_coupled[n[0] + i] == of_chain[n[1] + i]
