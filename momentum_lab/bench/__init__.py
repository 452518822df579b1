"""How long each part of a tick takes, beside PlaCo on the same robot in the same run."""
