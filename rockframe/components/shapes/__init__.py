"""Bodies as they are: mass, centre of mass, inertia and base from their shape."""
