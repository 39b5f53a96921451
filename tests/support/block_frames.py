"""What stands before and after a single block that is tried on the machine of a control."""

HEADS = {
    "matsuura_mx330": "%\nO0001\nG21 G17 G90 G94 G54\n",
    "haas_umc750": "%\nO00001\nG21 G17 G90 G94 G54\n",
    "xyzac_trt": "G21 G17 G90 G94 G54\n",
    "hs664rt": "G90\nG71\nG55 O1\n",
    "yl569": "G710 G17 G90 G94 G54\nT1\nM6\nD1\nS500 F100 M3\n",
    "dmu65": "0 BEGIN PGM A MM\nTOOL CALL 1 Z S500\n",
}

TAILS = {"dmu65": "END PGM A MM\n"}
