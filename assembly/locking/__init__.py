"""The order in which geodesics lock a hoisted shell."""
