"""Certificates: how sure a verdict is, by runs of higher accuracy and with changed inputs."""
