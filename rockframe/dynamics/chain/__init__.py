"""Any number of bodies, each on a base on the body below it, from lists of numbers."""
