"""Plans the assembly of a gridshell; knows no CAD kernel."""
