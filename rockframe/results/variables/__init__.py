"""The rows of the table of variables, grouped by what they describe."""
