"""Simulation-based temporal projection for everyday robot manipulation."""
