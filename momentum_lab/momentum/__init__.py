"""What the chapter says about momentum: pure functions of arrays, with no state and no solver."""
