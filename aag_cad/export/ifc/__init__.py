"""The gridshell as IFC."""
