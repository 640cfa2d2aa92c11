"""Stuffs that consist of many solid bodies: beads, peas, gravel."""
