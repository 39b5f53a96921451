"""The viewer: a program on its machine, block by block, in a browser.

``motion``   a run as columns in which every axis moves evenly
``content``  what a page shows: machine, bodies, tools, texts, findings and columns
``page``     the page; with its content in it, it works offline
``server``   the page on loopback, with its content beside it

``web`` is what runs in the browser: plain modules and a style, and two vendored libraries.
"""
