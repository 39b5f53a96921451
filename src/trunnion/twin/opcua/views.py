"""Browsing, with the subtypes of references looked up once: clients browse hundreds of nodes when they connect."""

from asyncua import ua
from asyncua.server.address_space import AddressSpace, ViewService

#: All references are meant.
_ANY = ua.NodeId(ua.ObjectIds.Null)


class TwinViews(ViewService):
    """Browses an address space; what it has looked up holds until nodes are added."""

    def __init__(self, nodes: AddressSpace) -> None:
        super().__init__(nodes)
        self._subtypes: dict[ua.NodeId, frozenset[ua.NodeId]] = {}
        self._nodes = 0

    def _suitable_reftype(self, ref1: ua.NodeId, ref2: ua.NodeId, subtypes: bool) -> bool:
        """Whether a reference of type ``ref2`` is one of type ``ref1``, or of one of its subtypes."""
        if ref1 in (_ANY, ref2):
            return True
        if not subtypes:
            return False
        nodes = len(self._aspace.keys())
        if nodes != self._nodes:
            self._subtypes, self._nodes = {}, nodes
        if ref1 not in self._subtypes:
            if ref1 not in self._aspace:
                return False
            self._subtypes[ref1] = frozenset(self._get_sub_ref(ref1))
        return ref2 in self._subtypes[ref1]
