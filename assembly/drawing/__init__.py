"""Lines and shapes on paper; knows no plan."""
