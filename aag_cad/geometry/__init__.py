"""Curvature of curves on surfaces, surfaces of revolution, splines and geodesics."""
