"""Operations on ground motions; each returns a new motion and adds a sentence to its history."""
