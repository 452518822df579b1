"""Why this torque: desired momentum rates, what the ground admits of them, accelerations and torques."""
