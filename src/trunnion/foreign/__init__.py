"""Posts and machine data of others as definitions of machines.

files ──nx_post, mastercam, machine_data──▶ ForeignMachine ──written_definition──▶ TOML that extends a shipped machine
                                                           ──differences─────────▶ what a definition has otherwise
"""
