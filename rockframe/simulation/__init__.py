"""From an assembled system to labelled results."""
