"""Assembly of parts to a scene, and of a scene to its equations."""
