Dear John,
please find the fixture drawing attached. Call me at N10 if the part (rev B) is late.
