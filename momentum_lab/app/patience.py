"""How long nobody has to touch a tab of the lab before it plays by itself."""

PATIENCE = 120.0
"""If nothing else is asked for, s."""
LEAST_PATIENCE, MOST_PATIENCE = 5.0, 600.0
"""What can be asked for, s."""
