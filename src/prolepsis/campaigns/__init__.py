"""Many runs of one scenario: sweeps, and how their outcomes are told."""
