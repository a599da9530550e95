"""Rules of sealed datagrams, broken on purpose. See mutations.py."""

from mutation import Mutation

ENVELOPE = "transport/envelope/"
PROGRAM = "transport_seal_test"


def rule(name, file, find, replace, test="*"):
    return Mutation(name, ENVELOPE + file, find, replace, f"{PROGRAM}:{test}")


def wire(name, file, find, replace):
    """A rule that both sides break alike: only recorded bytes notice."""
    return Mutation(name, ENVELOPE + file, find, replace, "wire_format_test:EnvelopeBytes.*")


MUTATIONS = [
    # The header and what is authenticated with it
    rule("a plain datagram is taken for a sealed one", "Outer.cpp", "(datagram[0] & MarkBits) != SealedMark", "false"),
    rule("a signed datagram may name its receiver alone", "Outer.cpp", "outer.Kind == ReservedKind", "false"),
    rule("a datagram may be too short for its kind", "Outer.cpp", "datagram.size() < OuterOverhead(outer.Kind)",
         "datagram.size() < OuterSize"),
    rule("a claim may be of any class", "Outer.cpp", "outer.Class != OuterClass::Meeting ||", ""),
    rule("an epoch may be none", "Outer.cpp", "outer.Epoch == 0 ? OuterFault::NoEpoch : OuterFault::None", "OuterFault::None"),
    rule("the receiver is not authenticated", "Outer.cpp", "fields.Add(receiver);", "fields.Add(AllSessions);"),
    rule("the header left out is not authenticated", "Outer.cpp", "fields.Add(left);", "fields.Add(RtpsHeader{});"),
    rule("the high half is not authenticated", "Outer.cpp",
         "fields.Add(static_cast<std::uint32_t>(number >> 32));", "fields.Add(std::uint32_t{0});"),
    # Keys
    rule("both directions have one key", "Session.cpp",
         "PairwiseKey(secret, epoch, *shared, self, _sender)", "PairwiseKey(secret, epoch, *shared, _sender, self)"),
    wire("a pairwise key outlives the receiver's session", "KeyDerivation.cpp",
         ".Add(receiver.Session)", ".Add(SessionId{})"),
    rule("a tag does not depend on the certificate", "KeyDerivation.cpp",
         "content.Add(end.Session).Add(end.Certificate);", "content.Add(end.Session);"),
    rule("keys are derived anew for each epoch in turn", "Session.cpp", "keys.Of < oldest->Of ? &keys : oldest", "oldest"),
    wire("the nonce is always the same", "Aead.cpp", "LittleEndian::Write(number, nonce.data() + 4);", "(void)number;"),
    # Numbers
    rule("a number is taken twice", "ReplayWindow.h", "_any = true; WordOf(number) |= BitOf(number);", "_any = true;"),
    rule("the window is one larger", "ReplayWindow.h", "_highest - number >= Size", "_highest - number > Size"),
    rule("what was jumped over was taken", "ReplayWindow.h", "WordOf(number - i * Bits) = 0;", ""),
    rule("nothing is below the floor", "ReplayWindow.h", "number < _floor ||", ""),
    rule("a number does not wrap", "ReplayWindow.h", "return here + Step;", "return here;"),
    rule("numbers begin again at their end", "Sealer.cpp", "_self.Next == std::numeric_limits<std::uint64_t>::max()", "false"),
    # Opening
    rule("a number is not looked up", "Opener.cpp",
         "FaultOf(session.Window().Look(number)); fault != OpenFault::None", "FaultOf(session.Window().Look(number)); false"),
    rule("a number is marked too early", "Opener.cpp", "const bool isFresh = session.IsFresh(now);",
         "const bool isFresh = session.IsFresh(now); session.Window().Mark(number);"),
    rule("a claim's number is not looked up", "Opener.cpp",
         "FaultOf(known->Window().Look(number)); fault != OpenFault::None", "FaultOf(known->Window().Look(number)); false"),
    rule("no signature of a fresh session is verified", "Opener.cpp", "if (HasGoodSignature(size, session.Certificate().Key))",
         "if (true)"),
    rule("no signature of others is verified", "Opener.cpp", "HasGoodSignature(size, key) ?", "true ?"),
    rule("any authority will do", "Opener.cpp", "!IsCertifiedBy(claim->Certificate, _authority)", "false"),
    rule("any certificate will do", "Opener.cpp", "!verifying || Sha256(claim->Certificate) != sender.Certificate",
         "!verifying"),
    rule("traffic of yesterday is taken", "Opener.cpp", "!isFresh && outer.Class != OuterClass::Bulletin", "false"),
    rule("a card of yesterday is taken", "Opener.cpp", "!isFresh && outer.Class != OuterClass::Bulletin",
         "!isFresh && outer.Class == OuterClass::Traffic"),
    rule("bulletins of strangers are not taken", "Opener.cpp", "!isFresh && outer.Class != OuterClass::Bulletin", "!isFresh"),
    rule("former epochs are taken for ever", "Opener.cpp",
         "use == EpochSecrets::Use::Bulletin && outer.Class != OuterClass::Bulletin", "false"),
    rule("a revoked session is heard", "Opener.cpp", "_epochs.IsRevoked(session.Certificate().Content.Number)", "false"),
    rule("a revoked certificate claims", "Opener.cpp", "_epochs.IsRevoked(certificate->Content.Number)", "false"),
    rule("strangers have all of the processor", "Opener.cpp",
         "if (!budget.Take(now)) { return OpenFault::OverBudget; }", "budget.Take(now);"),
    rule("forgers have all of the processor", "Opener.cpp",
         "session.IsSuspect(isNewest, now) && !forgeries.HasLeft(now)", "false"),
    rule("a flood in one name keeps back all", "Opener.cpp",
         "session.IsSuspect(isNewest, now) && !forgeries.HasLeft(now)", "!forgeries.HasLeft(now)"),
    rule("a revoked member keeps back members", "Opener.cpp", "isNewest ? _forgeries : _formerForgeries", "_forgeries"),
    rule("anybody makes keys be derived", "Opener.cpp", "else if (!_introductions.Take(now))", "else if (false)"),
    rule("anybody makes this node ask without end", "Opener.cpp", "budget.Take(now) ? fault : OpenFault::OverBudget", "fault"),
    rule("a claim over budget asks for nothing", "Opener.cpp", "result.Challenge = claim->Challenge;", ""),
    rule("answers and strangers share", "Opener.cpp", "liveAt ? _answers : _strangers", "_strangers"),
    rule("a datagram may name any source", "Opener.cpp", "!SpeaksForItself(message, session)", "false"),
    # Freshness
    rule("silence may last", "Session.h", "_proven && now - _heard <= SilenceAllowed", "_proven"),
    rule("a recording passes after the proof", "Session.cpp", "_window.SetFloor(number);", ""),
    rule("a proof counts from when it comes", "Session.cpp", "_heard = at;", "_heard = now;"),
    rule("an answer counts for ever", "OwnChallenges.h", "|| now - asked.At > AnswersCountFor", ""),
    rule("no nonce may be answered", "OwnChallenges.h", "asked.Of == Nonce{} ||", ""),
    rule("an invented session is asked again and again", "ClaimExchange.cpp",
         "question.Left -= question.Of == Standing::Unknown ? 1 : 0;", ""),
    rule("each repeated question is answered at once", "ClaimExchange.cpp",
         "now - answered->At < answered->Gap.Interval()", "false"),
    rule("recordings displace the questions of claims that were verified", "ClaimExchange.cpp",
         "least->second.By > standing", "false"),
    rule("recordings are answered as often as they come", "ClaimExchange.cpp",
         "_unprovenNotBefore = now + _unprovenGap.Next();", ""),
    # Blobs
    rule("a liar keeps a blob back", "BlobExchange.cpp", "now - lack.Since > turns * lack.Turn", "false"),
    rule("others postpone an offer for ever", "BlobExchange.cpp", "std::min(others, offered->second.Latest)", "others"),
    # Pace of introductions
    rule("each node has the pace of all", "SharedPace.h", "AllTogether / nodes,", "AllTogether,", "SharedPaces.*"),
    rule("recordings of many nodes end all introductions", "SharedPace.h", "_others.size() < MostOthers ||", "true ||", "SharedPaces.*"),
    rule("a node counts for ever", "SharedPace.h", "now - each.second > Counts", "false", "SharedPaces.*"),
    # Sessions
    rule("a prefix may have two speakers", "SessionTable.cpp",
         "if (const std::string *const holder = HolderOf(facts))",
         "if (const std::string *const holder = nullptr)"),
    rule("a mere claim holds a prefix", "SessionTable.cpp", "session->IsProven() && session->Sender().Certificate",
         "session->Sender().Certificate"),
    rule("silent sessions fill the table", "SessionTable.cpp", "session.IsProven() && now - session.Heard() <= HoldsFor",
         "session.IsProven()"),
    rule("a claim displaces a proof of its tag", "SessionTable.cpp", "(known->IsProven() || !facts.LiveAt)", "false"),
    rule("recordings fill the table", "SessionTable.cpp",
         "isCounted && alike >= (facts.LiveAt ? MostProvenOfOne : MostUnprovenOfOne)",
         "isCounted && alike >= MostProvenOfOne"),
    rule("one certificate fills the table", "SessionTable.cpp", "|| (facts.LiveAt && !known->IsProven())", ""),
    rule("the table is not bounded", "SessionTable.cpp", "known != nullptr || _sessions.size() < Most", "true"),
    rule("a displaced session is forgotten", "SessionTable.cpp", "highest != nullptr && number <= *highest", "false"),
    rule("a displaced session begins anew", "SessionTable.cpp", "known->Window().SetFloor(*highest + 1);", ""),
    rule("headers change", "SessionTable.cpp", "isSame && known->Headers() != facts.Headers", "false"),
    # Certificates, permissions, bulletins
    rule("a tool writes", "Permissions.cpp", "(role == CertificateRole::Node || topic.starts_with(OwnTopics)) &&", ""),
    rule("an old epoch is learned", "EpochSecrets.cpp", "epoch <= Newest()", "epoch == 0"),
    rule("the newest epoch ends", "EpochSecrets.cpp", "isNewest || now - (known + 1)->Learned <= Overlap", "isNewest"),
    rule("a bulletin of anybody is taken", "Bulletin.cpp",
         "|| !authority.Verify(LabelledBulletin(content), bytes.last(sizeof(Signature)))", ""),
    rule("two certificates share a key of a bulletin", "Bulletin.cpp", "LittleEndian::Put(node.Number, info);", ""),
    rule("one is revoked and named", "Bulletin.cpp", "nodes.size() > MostBulletinNodes || !AreApart(revoked, nodes)",
         "nodes.size() > MostBulletinNodes"),
    # Sealing
    rule("statistics may overwrite the end", "Sealer.cpp", "if (!LooksLikeStatistics(datagram))", "if (true)"),
    rule("an open submessage swallows the padding", "Sealer.cpp", "(length > 0 || isEmpty) &&", "", "SealStorm.*"),
    rule("a sender seals as another", "Sealer.cpp", "if (header == _self.Headers.end())", "if (false)", "SealedDatagram.*"),
]
