"""The waist of the hourglass: things, logs and timelines, and the sealed folders that they are saved in."""
