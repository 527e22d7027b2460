"""How sure the verdict of a run is: runs beside it, by finer means and with changed inputs."""
