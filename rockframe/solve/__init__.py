"""Event-driven time integration; knows a contact model only by its protocol."""
