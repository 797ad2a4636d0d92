"""The workshop: equal planks, stock and cutting, sheets, passports; from the gridshell, without a CAD kernel."""
