"""Walls that yield: bowls of paper and clay."""
