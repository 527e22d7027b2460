"""Records that come with the package, as published, and where they are from."""
