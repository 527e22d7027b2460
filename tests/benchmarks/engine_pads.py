"""The block on two pads in MuJoCo, a multibody engine that shares no code with rockframe.

The model defines the bodies and their joints; the equations of motion are the engine's. A platform
slides horizontally; it is so heavy, `HEAVY` times the block, that a force of its mass times the
ground acceleration moves it like the ground. The block stands on it: the held point of its base may
rise (a vertical slide), and the block may rotate about it (a hinge). There are no collisions. The
pads push at the corners, and the engine supplies the positions and velocities of these and their
Jacobians: no lever and no inertial term is written here. Only the law of a pad, without memory, is
written by hand,

    N = max(0, k (delta - y) - c dy/dt)   below the top of the unloaded pad, y < delta,
    N = 0                                 above,

evaluated at every stage of the engine's Runge-Kutta method (fourth order).

The position of the hinge sets the held point; there is a model for each point, and one for flight
with a second horizontal slide. Where the model changes, momenta are projected on the new
coordinates, from which the engine's mass matrix gives the new rates.
"""

from collections.abc import Callable

import mujoco
import numpy as np

HEAVY = 1e12
"""Mass of the platform over the block's: the block's effect on it is below rounding."""
HALVINGS = 40
"""Number of bisections of a step to find a change of contact."""
SITES = ("left", "middle", "right")
FLIGHT = "nothing"
SHAKE, RISE, ROTATION = 0, -2, -1

MODEL = """
<mujoco>
  <option timestep="{step!r}" integrator="RK4" gravity="0 0 -{gravity!r}">
    <flag contact="disable" constraint="disable"/>
  </option>
  <worldbody>
    <body name="platform">
      <joint type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="{platform!r}" diaginertia="1 1 1"/>
      <body name="block" pos="{held!r} 0 0">
        {sway}
        <joint type="slide" axis="0 0 1"/>
        <joint type="hinge" axis="0 1 0"/>
        <inertial pos="{middle!r} 0 {half_height!r}" mass="{mass!r}"
                  diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
        <site name="left" pos="{left!r} 0 0"/>
        <site name="middle" pos="{middle!r} 0 0"/>
        <site name="right" pos="{right!r} 0 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
SWAY = '<joint type="slide" axis="1 0 0"/>'


class Pads:
    """The block at rest on its pads, to be shaken.

    Parameters
    ----------
    half_width, half_height, mass, inertia : float
        The block's; the inertia is about its centre of mass.
    stiffness, damping : float
        Of one pad.
    gravity : float
        Acceleration of gravity.
    acceleration : callable
        The ground's acceleration at an instant.
    step : float
        Time step.
    restraint : str
        ``centre``, ``leading-corner`` or ``contact-state``. The held point changes between steps.
    meet_changes : bool
        Whether a step in which contact changes is split at the change. Contact within a step is
        then that at its beginning.
    """

    def __init__(
        self,
        *,
        half_width: float,
        half_height: float,
        mass: float,
        inertia: float,
        stiffness: float,
        damping: float,
        gravity: float,
        acceleration: Callable[[float], float],
        step: float,
        restraint: str = "centre",
        meet_changes: bool = False,
    ) -> None:
        self._stiffness, self._damping = stiffness, damping
        self._settlement = 0.5 * mass * gravity / stiffness
        self._mass, self._inertia = mass, inertia
        self._acceleration = acceleration
        self._step, self._restraint, self._meet_changes = step, restraint, meet_changes
        b = half_width
        given = {
            "half_height": half_height, "mass": mass, "inertia": inertia, "gravity": gravity,
            "platform": HEAVY * mass, "step": step,
        }  # fmt: skip
        self._models = {}
        for name, held in zip((*SITES, FLIGHT), (-b, 0.0, b, 0.0), strict=True):
            places = {"held": held, "left": -b - held, "middle": -held, "right": b - held}
            model = MODEL.format(sway=SWAY if name == FLIGHT else "", **places, **given)
            self._models[name] = mujoco.MjModel.from_xml_string(model)
        self._held = "middle"
        self._model = self._models[self._held]
        self._data = mujoco.MjData(self._model)
        self._block = self._model.body("block").id
        self._sites = {name: self._model.site(name).id for name in SITES}
        self._jacobian = np.zeros((3, self._model.nv))
        self._contact: tuple[bool, bool] | None = None

    def run(self, outputs: int, steps_per_output: int) -> np.ndarray:
        """Integrate; return the clockwise rotation at the start and at every output time."""
        rotation = np.zeros(outputs + 1)
        mujoco.set_mjcb_passive(self._push)
        try:
            for row in range(1, outputs + 1):
                for _ in range(steps_per_output):
                    self._advance()
                rotation[row] = self._data.qpos[ROTATION]
        finally:
            mujoco.set_mjcb_passive(None)
        return rotation

    def _push(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Callback of the engine: add the forces on the platform and at the corners."""
        forces = data.qfrc_passive
        forces[SHAKE] += HEAVY * self._mass * self._acceleration(data.time)
        left, right = self._contact or (None, None)
        for site, held in (("left", left), ("right", right)):
            below, force = self._pad(site)
            if (below and force > 0.0) if held is None else held:
                forces += force * self._jacobian[2]

    def _pad(self, site: str) -> tuple[bool, float]:
        """Return whether a corner is below the top of its unloaded pad, and the pad's force law."""
        corner = self._sites[site]
        mujoco.mj_jacSite(self._model, self._data, self._jacobian, None, corner)
        gap = self._settlement - self._data.site_xpos[corner, 2]
        speed = float(self._jacobian[2] @ self._data.qvel)
        return gap > 0.0, self._stiffness * gap - self._damping * speed

    def _advance(self) -> None:
        """Make one step, in parts if contact changes in it and changes are to be met."""
        left = self._step
        while left > 1e-9 * self._step:
            state = self._state()
            self._hold(state)
            if not self._meet_changes:
                self._go(left)
                return
            self._contact = state[:2]
            data = self._data
            start = data.qpos.copy(), data.qvel.copy(), data.time
            self._go(left)
            if self._state() == state:
                return
            low, high = 0.0, left
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                self._go(middle, start)
                if self._state() == state:
                    low = middle
                else:
                    high = middle
            self._go(high, start)
            left -= high

    def _go(self, length: float, start: tuple | None = None) -> None:
        """Make a step of a given length, optionally from an earlier state."""
        data = self._data
        if start is not None:
            data.qpos[:], data.qvel[:], data.time = start
        self._model.opt.timestep = length
        mujoco.mj_step(self._model, data)

    def _state(self) -> tuple[bool, bool, bool]:
        """Tell whether the left and the right corner press, and whether the block leans right."""
        mujoco.mj_fwdPosition(self._model, self._data)
        left, right = (below and force > 0.0 for below, force in map(self._pad, SITES[::2]))
        leans = self._restraint == "leading-corner" and bool(self._data.qpos[ROTATION] > 0.0)
        return left, right, leans

    def _hold(self, state: tuple[bool, bool, bool]) -> None:
        """Place the hinge by the restraint rule, or release it."""
        left, right, leans = state
        if not (left or right):
            wanted = FLIGHT
        elif self._restraint == "leading-corner":
            wanted = "right" if leans else "left"
        elif self._restraint == "contact-state" and left != right:
            wanted = "left" if left else "right"
        else:
            wanted = "middle"
        if wanted == self._held:
            return
        velocity, spin = (jacobian @ self._data.qvel for jacobian in self._motion_of_centre())
        old, data = self._data, mujoco.MjData(self._models[wanted])
        data.time = old.time
        data.qpos[ROTATION] = old.qpos[ROTATION]
        data.qpos[RISE] = old.site_xpos[self._sites["middle" if wanted == FLIGHT else wanted], 2]
        self._held, self._model, self._data = wanted, self._models[wanted], data
        self._jacobian = np.zeros((3, self._model.nv))
        mujoco.mj_fwdPosition(self._model, data)
        along, turning = self._motion_of_centre()
        momenta = self._mass * (along.T @ velocity) + self._inertia * (turning.T @ spin)
        momenta[SHAKE] += HEAVY * self._mass * old.qvel[SHAKE]
        rates = np.zeros((1, self._model.nv))
        mujoco.mj_solveM(self._model, data, rates, momenta[None])
        data.qvel[:] = rates[0]

    def _motion_of_centre(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the Jacobians of the centre of mass's place and of the block's turn."""
        along, turning = np.zeros((2, 3, self._model.nv))
        mujoco.mj_jacBodyCom(self._model, self._data, along, turning, self._block)
        return along, turning
