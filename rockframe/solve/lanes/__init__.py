"""Many runs of one kind of system side by side, one in each lane of a processor's registers."""
