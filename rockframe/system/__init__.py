"""Assembly: from the parts that users give to a scene, and from a scene to its equations."""
