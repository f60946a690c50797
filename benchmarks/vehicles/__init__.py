"""Random vehicles by both routes, and a vehicle of many stations against the clock."""
