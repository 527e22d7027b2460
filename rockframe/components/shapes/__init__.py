"""Bodies of any shape: mass, centre of mass, moment of inertia and base from the shape."""
