"""Loops over the particles of a log, compiled by numba: imported only for logs that have particles."""
