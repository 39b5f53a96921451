"""The virtual control that all families share: positions, frames, circles, and the rows that motions become."""
