"""A vehicle of any sections: its data, its exact modes, its matrices."""
