"""Writer of Heidenhain iTNC 530 and TNC 640."""
