"""The other nodes, as a node knows them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any


class Fleet:
    """The message `Gateway/Fleet` (idl/messages/gateway.idl): `fleet["uav1"].state`, `fleet.problems`."""

    def __init__(self, value: Any) -> None:
        self.value = value
        self.nodes: dict[str, Any] = {status.node: status for status in value.nodes}

    @property
    def problems(self) -> list[Any]:
        """The problems that keep data from flowing, each with `subject` and `reason`."""
        return list(self.value.problems)

    def __getitem__(self, node: str) -> Any:
        return self.nodes[node]

    def __contains__(self, node: object) -> bool:
        return node in self.nodes

    def __iter__(self) -> Iterator[str]:
        return iter(self.nodes)

    def __len__(self) -> int:
        return len(self.nodes)

    def is_up(self, node: str) -> bool:
        """True if that node is heard."""
        return node in self.nodes and self.nodes[node].state.name == "UP"

    def __repr__(self) -> str:
        return f"<Fleet {', '.join(f'{name} {status.state.name}' for name, status in self.nodes.items())}>"
