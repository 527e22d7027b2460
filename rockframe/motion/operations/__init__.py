"""What may be done to a ground motion; each step returns a new one and says what it did."""
