"""Random general systems by both routes, class by class, and a sample against ball arithmetic."""
