"""The gridshell as plain frozen data."""
