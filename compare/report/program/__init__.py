"""The report's own programs, run again from their data cards."""
