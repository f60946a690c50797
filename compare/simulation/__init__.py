"""A motion followed over many periods, beside what theory says of its growth."""
