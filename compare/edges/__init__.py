"""Boundaries of instability: followed as curves, named, measured."""
