"""Event-driven integration; knows contact models only by their protocol."""
