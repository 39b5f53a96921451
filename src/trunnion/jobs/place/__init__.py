"""Where on the table a part may sit."""
