"""What languages of the RS274 kind share: blocks of letters and numbers, and their arithmetic."""
