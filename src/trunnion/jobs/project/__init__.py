"""The set-ups of a part: posted together, compared with what was released, watched."""
