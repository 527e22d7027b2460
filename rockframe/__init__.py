"""rockframe."""
