"""The witness's vehicle: finite elements of the weak form, assembled by scikit-fem."""
