"""The particle liquid: incompressible, viscous, with surface tension and walls; kernels over plain arrays."""
