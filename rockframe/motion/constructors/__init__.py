"""How ground motions are made: from files and arrays, from formulas, from models."""
