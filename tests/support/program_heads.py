"""The beginning and the end of a program in each language, with room for lines between them."""

#: By machines; ``{lines}`` is where the lines go.
HEADS = {
    "mikron_600u": "BEGIN PGM A MM\nTOOL CALL 5 Z S500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"
    "{lines}\nL Z+5 F100\nM30\nEND PGM A MM\n",
    "matsuura_mx330": "%\nO0001\nG21 G90 G94\nT5 M6\nG54 S500 M3\nG43 H5 G0 X0. Y0. Z50.\n"
    "{lines}\nG1 Z5. F100.\nM30\n%\n",
    "yl569": "T5 M6\nG54 S500 M3\nG0 X0 Y0 Z50 D1\n{lines}\nG1 Z5 F100\nM30\n",
    "xyzac_trt": "G21 G90 G94\nT5 M6\nG54 S500 M3\nG0 X0 Y0 Z50\n{lines}\nG1 Z5 F100\nM2\n",
    "hs664rt": "G71\nM306 T.5\nG55 O1\nM3 S500\nG1 X0. Y0. Z50. F3000\n{lines}\nG1 Z5. F100\nM02\n",
}
