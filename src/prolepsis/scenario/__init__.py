"""A scenario: its file, its parameters and what it changes in the knowledge."""
