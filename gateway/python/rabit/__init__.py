"""Distributed Rabit for Python: nodes of a fleet, its messages and queues, and its recordings.

    import rabit

    idl = rabit.load_idl("uav.idl")
    with rabit.Node("planner", domain=7) as node:
        for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
            print(pose.node, pose.age, pose.value.altitude_m)
"""

from ._agreement import Claim, Claims, SharedTable
from ._fleet import Fleet
from ._idl import Namespace, from_bytes, from_json, load_idl, message_class, to_bytes, to_json
from ._manager import Manager
from ._messages import Message, Union, asdict, replace
from ._node import Node
from ._rabit import Command, ConfigError, Received, __version__, load_library, set_log_level, transports
from .recordings import Recorded, Recording, Topic, open
from ._streams import Outcome, Queue, Receipt, Subscription

__all__ = [
    "Claim",
    "Claims",
    "Command",
    "ConfigError",
    "Fleet",
    "Manager",
    "Message",
    "Namespace",
    "Node",
    "Outcome",
    "Queue",
    "Receipt",
    "Received",
    "Recorded",
    "Recording",
    "SharedTable",
    "Subscription",
    "Topic",
    "Union",
    "__version__",
    "asdict",
    "from_bytes",
    "from_json",
    "load_idl",
    "load_library",
    "message_class",
    "open",
    "replace",
    "set_log_level",
    "to_bytes",
    "to_json",
    "transports",
]
