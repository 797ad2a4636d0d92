"""Solids, curves and meshes for other CAD programs."""
