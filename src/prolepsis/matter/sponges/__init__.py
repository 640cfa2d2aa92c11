"""Sponges: they absorb, drip and are pressed out."""
