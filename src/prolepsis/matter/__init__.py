"""Kinds of matter that rigid bodies do not cover, a room each: what it adds to a scene, its law, its controller."""
