"""Two bodies in series, Eq. (20): the lower one shakes the upper one, which does not act back."""
