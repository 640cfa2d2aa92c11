"""The commands, one a file: its arguments with help and an example, and what it prints.

What they work with is imported when they run, so that each starts fast.
"""
