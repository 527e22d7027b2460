"""What an answer says of the motion that it belongs to."""

from typing import TYPE_CHECKING

from rockframe.measures.component import GroundComponent

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion


def about(motion: "GroundMotion", component: GroundComponent) -> dict[str, str | float | int]:
    """Describe a motion so that it can be recognised.

    Parameters
    ----------
    motion : GroundMotion
        The motion.
    component : GroundComponent
        The component that was looked at.

    Returns
    -------
    dict
        Attributes of a dataset.
    """
    return {
        "motion": motion.name,
        "motion_sha256": motion.sha256,
        "motion_time_step": motion.si.time_step,
        "motion_samples": len(motion),
        "motion_history": "; ".join(motion.history),
        "component": str(component),
    }
