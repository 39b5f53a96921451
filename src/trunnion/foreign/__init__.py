"""Posts and machine data of others as definitions of machines.

files ──nx_post, machine_data──▶ ForeignMachine ──written_definition──▶ TOML that extends the nearest shipped machine
                                                ──differences──────────▶ what a definition has otherwise
"""
