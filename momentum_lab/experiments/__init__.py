"""Experiments: the chapter's figures and statements as runs whose claims are measured and can fail."""
