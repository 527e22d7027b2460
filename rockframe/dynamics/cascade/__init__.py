"""A body on a base, and on its cap another body that does not act back, Eq. (20)."""
