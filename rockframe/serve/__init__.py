"""A local page on which a scene is tried: sliders, verdict, player, and the scene as a file."""

from rockframe.serve.server import Server as Server
