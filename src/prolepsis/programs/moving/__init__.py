"""How hands are moved: where they grasp and hold, along which paths, in which time. Actions share it."""
