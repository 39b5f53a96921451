"""Reader of Heidenhain Klartext, iTNC 530 and TNC 640: the language, and a control that executes it."""
