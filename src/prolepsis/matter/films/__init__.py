"""Films that make slippery and that stick."""
