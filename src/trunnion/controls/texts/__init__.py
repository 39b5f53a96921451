"""Templates with conditions, loops and expressions: Jinja, of which very little is let in.

In:     the text of a definition, which may have come by mail.
Out:    lines of a program, or an error at the line of the definition.

A template may look at values, compare them, calculate with numbers and go through lists. ``tree`` checks the tree that
Jinja's parser makes against a list of what may stand in it, and nothing else reaches Jinja's compiler: no call, no
macro, no file, no method, no attribute but those of records. What is let in is bounded: each pass of a loop and each
expression costs steps of the program's ``Budget`` before it runs, and every text that is made has a greatest length.
Jinja's own sandbox stands behind that.

Jinja is imported where a definition has such a template: others start without it.
"""
