"""The first lines of a CL file in each dialect of APT, up to the first motion."""

HEADS = {
    "clt": ["UNITS/ MM", "CUTTER/ 10.0,1.0", "OPFEATSTART/Mill1", "ROTABL/ 0.0,AAXIS,TABLE,CCLW"],
    "apt": ["PARTNO A", "UNITS/MM", "CUTTER/10,1", "LOADTL/5"],
    "ncl": ["$$* Pro/CLfile Version 8.0", "UNITS / MM", "LOADTL / 5", "$$-> CUTTER / 10.0"],
    "solidworks": [
        "PARTNO/1",
        "UNIT/MM",
        "INSERT/MILL",
        "CUTTER/10.,0,5.,0,0,0,60.",
        "LOAD/TOOL,5",
        "TRNTYP/WORLD,0,0,0",
    ],
    "fusion": ["PARTNO/'1001'", "UNITS/MM", "PPRINT/'Face1'", "MULTAX/OFF", "CUTTER/10., 1.", "LOADTL/5, 0, 60., 5"],
    "catia": ["$$ CATIA APT VERSION 1.0", "MULTAX", "CUTTER/10,1,4,1,0,0,50", "TPRINT/T5 End Mill", "LOADTL/5"],
}
