"""What an answer says of the motion that it belongs to."""

from typing import TYPE_CHECKING, Final

from rockframe.measures.component import GroundComponent

if TYPE_CHECKING:
    from rockframe.motion import GroundMotion


REFERENCES: Final = (
    "Nigam and Jennings (1969), Bull. Seism. Soc. Am. 59, 909-922; Arias (1970), in Seismic Design "
    "for Nuclear Power Plants; Rathje et al. (2004), Earthquake Spectra 20, 119-144"
)
"""Where spectra and intensity measures come from; page "Response spectra" has them all."""


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
        "references": REFERENCES,
    }
