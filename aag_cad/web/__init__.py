"""The discrete web of asymptotic and geodesic lines, and its quality."""
