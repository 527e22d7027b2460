"""The restraint rules in words and in the codes of the equations."""

from rockframe.system.options import Options, Restraint

_WORDS = {
    Restraint.CONTACT_STATE: (
        "contact-state: the middle of the base while both {ends} bear, else the bearing "
        "{end}; at each change the momentum is projected on the new restraint"
    ),
    Restraint.LEADING_CORNER: (
        "leading-corner: the corner towards which the block leans, in every contact state"
    ),
    Restraint.CENTRE: "centre: the middle of the base, in every contact state",
}


def restraint_words(options: Options, end: str = "corner") -> str:
    """Say which point of the base is held horizontally."""
    if options.small:
        return "the middle of the base (at small rotation the rules coincide)"
    return _WORDS[options.restraint].format(end=end, ends=f"{end}s")


def restraint_code(restraint: Restraint) -> int:
    """Give the equations' code of a rule."""
    from rockframe.dynamics import restraint as rules

    return {
        Restraint.CONTACT_STATE: rules.BY_CONTACT,
        Restraint.LEADING_CORNER: rules.LEADING_CORNER,
        Restraint.CENTRE: rules.CENTRE,
    }[restraint]
