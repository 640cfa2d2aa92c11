"""From knowledge to a scene of frozen values: things at their places, before any physics."""
