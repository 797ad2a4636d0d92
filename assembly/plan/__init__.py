"""What is done when: putting together, taking down, durations, schedule, reasons."""
