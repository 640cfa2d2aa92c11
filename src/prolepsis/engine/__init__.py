"""The engine: the one room, but for kinematics and pictures, that knows MuJoCo: models, the running state, the loop."""
