"""What is on the screen; the only folder that imports viser."""
