"""What the lab says about itself: the chapter's equations, measured."""
