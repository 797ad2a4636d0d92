"""The curves of one shell: selection, crossings, boundaries and crop."""
