"""What a point costs, here and elsewhere: ``python -m benchmarks``, then ``benchmarks.page``."""
