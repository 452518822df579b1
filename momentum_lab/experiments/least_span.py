"""What plots show at least, on the page and in pictures: a robot at rest looks at rest, and noise is not enlarged."""

from __future__ import annotations

# Little against a push that is worth looking at: 217 N for 100 ms, after which TALOS stands, give it 22 N s.
LEAST = {"places": 12.0, "linear": 60.0, "angular": 30.0, "momenta": 6.0}
"""Plot -> it shows at least from minus this to this: cm; N; N m; N s and kg m^2/s."""
