"""The commands, as data: a module for each group of them, in the order in which ``trunnion --help`` lists them."""
