"""What the world answers: ground, frictional contact, pushes, and the step from one state to the next."""
