"""The rows of the table of variables, by what they describe."""
