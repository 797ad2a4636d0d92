"""The order on the floor, what is walked for it, and where everything lies there."""
