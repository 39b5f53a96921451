"""The other side of a twin: an OPC UA client that records what a machine shows, and the files that it writes.

``nodes`` says what is recorded, ``client`` connects and subscribes, ``rows`` puts what arrives into rows, ``files``
writes and reads them, ``recorder`` goes on over breaks of the connection.
"""
