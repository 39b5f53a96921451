"""What writers of several families share."""
