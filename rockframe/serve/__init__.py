"""A local page to try a scene: sliders, the verdict, an animation, and the scene as a file."""

from rockframe.serve.server import Server as Server
