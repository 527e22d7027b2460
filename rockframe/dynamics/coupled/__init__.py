"""A body on a base on another body on its base, each acting on the other."""
