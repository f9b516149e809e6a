"""What a user's command found, in one shape, and the forms in which others read it."""
