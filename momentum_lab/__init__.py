"""momentum_lab: an interactive lab for momentum-based balance control of humanoids."""

__version__ = "0.1.0"
