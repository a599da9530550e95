"""What a whole node does, broken on purpose.

Each mutation says which program must notice: the simulation of the fleet, within the seeds tried, or a test program
where random runs get there too seldom or the links make up for it.
"""

from mutation import Mutation

FLEET = "fleet_simulation"
NODES = "gateway_nodes_test"
PARTS = "gateway_parts_test"

MUTATIONS = [
    # Mirrors
    Mutation("a repeated state is stamped anew", "TopicPublisher.cpp", "_writer.Write(*_local, _time)",
             "_writer.Write(*_local, _source.At(now))", FLEET),
    Mutation("a held-up value replaces a newer one", "TopicSubscriber.cpp", "!posted || IsOvertaken(source, info)",
             "!posted", PARTS),
    Mutation("values are posted as of their arrival", "TopicSubscriber.cpp", "PostTime{stamp, *posted}",
             "PostTime{stamp, _workspace.GetClock().Monotonic()}", FLEET),
    Mutation("any life of an origin will do", "TopicSubscriber.cpp",
             "origin && origin->Incarnation == info.Incarnation;", "origin.has_value();", FLEET),
    Mutation("nothing that is posted is fetched", "TopicPublisher.cpp",
             "_local->FetchMessage() && _local->WasPosted()", "false && _local->FetchMessage()", FLEET),
    Mutation("versions are not told", "StateExchange.cpp", "_presence.SetStateVersion(place, version);", "", FLEET),
    Mutation("nothing is asked for", "StateExchange.cpp", "_presence.WantStates(ask.Node, ask.States, ask.Now, now);", "",
             FLEET),
    Mutation("what is asked for is not written", "StateExchange.cpp", "publishers[_states[place]].AskedFor(now);", "",
             FLEET),
    # Presence
    Mutation("a silent node stays UP", "PeerTable.cpp", "silence > peer.StaleAfter() && peer.State == NodeState::UP", "false",
             FLEET),
    Mutation("a silent node is never LOST", "PeerTable.cpp", "silence > peer.LostAfter() && peer.State != NodeState::LOST",
             "false", FLEET),
    Mutation("a beat that was held up counts as of now", "PeerTable.cpp",
             "std::min(now, peer.Clock.SentAt(source).value_or(now))", "now", PARTS),
    Mutation("the clock of an earlier life is kept", "PeerTable.cpp", "peer.Clock = PeerClock();", "", FLEET),
    Mutation("a node that comes back with a lower number is never heard", "PeerTable.cpp",
             "(incarnation < peer.Incarnation && now - peer.LastHeard > peer.StaleAfter())", "false", FLEET),
    Mutation("no beats are sent", "Presence.cpp", "if (!_writer)", "if (true)", FLEET),
    Mutation("announcements are not said", "BeatContents.cpp", "AddPart(beat, now, room);", "", FLEET),
    Mutation("nobody is asked for its announcement", "BeatContents.cpp", "wanted.offers = question.From;",
             "wanted.offers = BeatFormat::NotLacking;", NODES),
    Mutation("who asks is answered each time", "OffersAnswer.cpp", "_gap = std::min(2 * _gap, LongestGap);", "", PARTS),
    Mutation("any echo is believed", "PeerTable.cpp", "_sent.Find(own->beat);", "std::optional(Duration(0));", PARTS),
    Mutation("what is not as its digest says is taken", "OffersCollector.cpp",
             "if (Announcements::DigestOf(_bytes) != digest)", "if (false)", PARTS),
    # Queue messages
    Mutation("a program that is no node has its say", "PresenceInbox.cpp", "IsNodeName(info.Node) &&", "", PARTS),
    Mutation("a queue takes messages of everybody", "IncomingQueues.cpp", "|| !found->second.AcceptsFrom(source)", "",
             PARTS),
    Mutation("expired is called delivered", "LinkDriver.cpp", "return QueueOutcome::Expired;",
             "return QueueOutcome::Delivered;", FLEET),
    Mutation("in doubt is called expired", "LinkDriver.cpp", "return QueueOutcome::InDoubt;",
             "return QueueOutcome::Expired;", FLEET),
    Mutation("receipts of a gateway that ends are not settled", "LinkDriver.cpp", "_links->Close();", "", FLEET),
    Mutation("the receiver's manager is not told", "LinkDriver.cpp", "queue->NotifyEnqueued();", "static_cast<void>(queue);",
             FLEET),
    Mutation("send entries are not heeded", "SendOptions.cpp", "if (rule != rules.end())", "if (false)", FLEET),
    Mutation("what came again is not marked", "AcceptedQueue.cpp", "decoded.Message->SetRedelivered(redelivered);", "",
             FLEET),
    Mutation("nobody tells of room after a queue was exactly full", "AcceptedQueue.cpp",
             "_gate->Full = true;\n    return Free();", "return 0;", NODES),
    Mutation("a message is not looked for where it was decoded", "IncomingQueues.cpp",
             "if (next.Payload == payload.data())", "if (true)", PARTS),
    Mutation("a queue that is replaced is not found", "AcceptedQueue.cpp", "_queue = queue;\n",
             "_queue = _queue ? _queue : queue;\n", PARTS),
    Mutation("room in one queue is no news", "IncomingQueues.cpp", "if (queue.TakeRoomCame() || isOther)",
             "if (isOther)", NODES),
    Mutation("bytes that are no message are delivered", "AcceptedQueue.cpp",
             "return {LocalQueueResult::Undecodable, nullptr};", "return {LocalQueueResult::Ok, std::move(message)};",
             PARTS),
    Mutation("in doubt is not counted", "LinkStatus.cpp", "row.in_doubt = counters.InDoubt;", "", FLEET),
    Mutation("a new incarnation is used before it is stored", "LinkDriver.cpp",
             "// What is sent now may tell of a new life.\n    _incarnations.Save();", "", NODES),
    Mutation("a node that is not live is unknown", "RemoteQueues.cpp", "_peers[peer.Node] = peer;",
             "if (peer.State == Gateway::NodeState::LOST) _peers.erase(peer.Node); else _peers[peer.Node] = peer;",
             FLEET),
]
