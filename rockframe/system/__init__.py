"""Assembly of parts into a scene, and of a scene into equations."""
