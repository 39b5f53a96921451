"""What languages of the RS274 kind share: blocks of letters and numbers, expressions, circles and cycles."""
