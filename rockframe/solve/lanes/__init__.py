"""Many runs of one kind of system side by side, with steps of fixed length."""
