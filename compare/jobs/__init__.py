"""Where evaluations run: processes, or a Dask cluster."""
