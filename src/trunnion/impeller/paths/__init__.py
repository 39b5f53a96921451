"""Tool paths of an impeller: where the tool's ball goes, then how the tool stands, then moves between cuts.

``shroud``     the form of the shroud, round the whole part
``channel``    passes between two blades: roughing and hub finish
``around``     passes round one blade: blade finish and root blend
``passes``     what all steps hand on: passes of ball centres on a family's own parameters
``tool_axes``  one smooth field of tool axes for a family, out of regions of directions (``axis_regions``,
               ``axis_field``) in which the whole tool is clear (``clearance``)
``linking``    leads, links and retracts, with the fewest points (``thinning``); ``toolpaths`` makes operations of them
"""
