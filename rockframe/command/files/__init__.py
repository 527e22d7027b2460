"""Files in TOML that describe scenes and studies."""
