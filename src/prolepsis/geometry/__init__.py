"""Where a shape's matter is and what its hollows hold: distances, bounds and cavities, for physics and for symbols.

Both halves of the hourglass may import this room, so it knows neither.
"""
