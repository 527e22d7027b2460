"""Records in the package, as published, and their sources."""
