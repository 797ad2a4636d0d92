"""Stresses of bent and twisted planks."""
