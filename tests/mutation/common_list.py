"""Rules of what the backends share, broken on purpose. See mutations.py."""

from mutation import Mutation

COMMON = "transport/common/"
PROGRAM = "transport_common_test"


def decision(name, find, replace):
    return Mutation(name, COMMON + "RejoinDecision.cpp", find, replace, f"{PROGRAM}:RejoinDecisionTest.*")


def choice(name, find, replace):
    return Mutation(name, COMMON + "NetworkChoice.cpp", find, replace, f"{PROGRAM}:NetworkChoice.*")


def duplicates(name, find, replace):
    return Mutation(name, COMMON + "DuplicateAddresses.cpp", find, replace, f"{PROGRAM}:DuplicateAddresses.*")


def gate(name, find, replace, test="*"):
    return Mutation(name, COMMON + "UseGate.h", find, replace, f"{PROGRAM}:UseGate.{test}")


def session(name, find, replace):
    return Mutation(name, COMMON + "RejoiningSession.cpp", find, replace, f"{PROGRAM}:RejoiningSessionTest.*")


def resolver(name, find, replace):
    return Mutation(name, COMMON + "PeerResolver.cpp", find, replace, f"{PROGRAM}:PeerResolver.*")


def buffers(name, find, replace, file="BufferPool.cpp"):
    return Mutation(name, COMMON + file, find, replace, f"{PROGRAM}:BufferPoolTest.*")


MUTATIONS = [
    # Memory of samples
    buffers("a small sample holds a large buffer", "SmallestBits = 7", "SmallestBits = 16", "BufferPool.h"),
    buffers("all buffers are kept", "_kept[bits] < std::max(BuffersKept * buffer.Capacity, BytesKept)", "true"),
    buffers("no buffer is kept", "_kept[bits] < std::max(BuffersKept * buffer.Capacity, BytesKept)", "false"),
    # When to join anew
    decision("a network is joined before it has lasted", "Since + SettleOf(network.Interface)", "Since"),
    decision("who comes and goes is trusted at once", "settle = std::min(2 * settle, _times.LongestSettle);", ""),
    decision("who comes and goes waits for ever", "std::min(2 * settle, _times.LongestSettle)", "2 * settle"),
    decision("nothing is forgotten", "times.front() + _times.Memory < now", "false"),
    decision("a network that goes is left at once", "gone->second + _times.LostFor", "gone->second"),
    decision("each network that goes is left", "gone != _gone.end() && IsMissed(network, view)", "gone != _gone.end()"),
    decision("no network that goes is left", "gone != _gone.end() && IsMissed(network, view)", "false"),
    decision("a network that returned counts as gone", "_gone.erase(KeyOf(network));", ""),
    decision("a peer on both networks does not count", "return onBoth || isRouted || isLocal;",
             "return isRouted || isLocal;"),
    decision("a peer behind a router does not count", "return onBoth || isRouted || isLocal;",
             "return onBoth || isLocal;"),
    decision("a peer on this host does not count", "return onBoth || isRouted || isLocal;",
             "return onBoth || isRouted;"),
    decision("a peer on this host counts for a lost carrier",
             "Names(peer, gone.Address) && !IsPresent(view.Host, gone) &&", "Names(peer, gone.Address) &&"),
    decision("this host's addresses are elsewhere",
             "if (std::none_of(host.begin(), host.end(), isOwn) && std::none_of(with.begin(), with.end(), isOwn))",
             "if (true)"),
    decision("loopback is joined at once", "*_allGone + _times.LostFor", "*_allGone"),
    decision("loopback is joined for a lost carrier", "network.IsSame(wanted) && network.Up",
             "network.IsSame(wanted) && network.Running"),
    decision("what has returned leaves loopback due", "if (present || !_isJoined)", "if (!_isJoined)"),
    decision("what is not to be used is kept", 'consider(Spaced(now), Describe(network) + " is not to be used");', ""),
    decision("the only network is left", "!network.Loopback && !view.Usable.empty()", "!network.Loopback"),
    decision("it joins as often as it likes", "_lastJoin ? std::max(due, *_lastJoin + _times.Spacing) : due", "due"),
    decision("it tries again as often as it likes", "now + _retry.Next()", "now + _times.Retry"),
    Mutation("it tries again ever more seldom", COMMON + "RejoinDecision.h", "{_times.Retry, _times.LongestRetry}",
             "{_times.Retry, _times.Memory}", f"{PROGRAM}:RejoinDecisionTest.*"),
    decision("old failures count", "_retry.Reset();", ""),
    decision("a peer's address is no reason", "if (view.PeersResolved && !view.Usable.empty())", "if (false)"),
    # Which networks
    choice("no carrier is needed", "network.Running && !network.Address.empty()", "!network.Address.empty()"),
    choice("no address is needed", "network.Running && !network.Address.empty()", "network.Running"),
    choice("loopback is one of them", "CanBeUsed(network) && !network.Loopback && (network.Multicast",
           "CanBeUsed(network) && (network.Multicast"),
    choice("there is never loopback", "if (choice.Usable.empty())", "if (false)"),
    choice("no multicast is needed", "(network.Multicast || !byMulticastAlone)", "true"),
    choice("peers do without multicast in vain", "settings.Multicast && settings.Peers.empty()", "settings.Multicast"),
    choice("multicast is switched off in vain", "settings.Multicast && settings.Peers.empty()",
           "settings.Peers.empty()"),
    choice("more than the backend takes", "choice.Usable.size() > most;", "false;"),
    choice("what is down has no carrier", "if (!found->Up)", "if (false)"),
    choice("what is missing is not told", "choice.Problems.push_back(WhyNot(name, host));", ""),
    # Addresses that another host has too
    duplicates("each address that a peer has too", "isItsToo && IsElsewhere(peer, usable) &&", "isItsToo &&"),
    duplicates("a process of this host is elsewhere", "std::none_of(usable.begin(), usable.end(), isOurs) &&", ""),
    duplicates("a peer behind a router is elsewhere", "&& std::any_of(usable.begin(), usable.end(), isNear)", ""),
    duplicates("they are never forgotten",
               "return std::none_of(usable.begin(), usable.end(), "
               "[&](const HostNetwork &network) { return network.IsSame(found); });", "return false;"),
    duplicates("they are forgotten at once",
               "return std::none_of(usable.begin(), usable.end(), "
               "[&](const HostNetwork &network) { return network.IsSame(found); });", "return true;"),
    # Recent entries
    Mutation("an old value stays", COMMON + "RecentMap.h", "found->second->second = std::move(value);", "",
             f"{PROGRAM}:RecentMap.*"),
    Mutation("an entry that is put again is forgotten first", COMMON + "RecentMap.h",
             "_entries.splice(_entries.end(), _entries, found->second);", "", f"{PROGRAM}:RecentMap.*"),
    # Users and changes
    gate("a change does not turn users away", "_gate._changing = true;", ""),
    # The other tests of UseGate would wait for ever to see the change.
    gate("a change does not wait for users", "_gate._mutex.lock();", "_gate._mutex.lock_shared();",
         "AChangeAndItsUsersNeverOverlap"),
    gate("a change never ends", "_gate._changing = false;", ""),
    gate("users do not heed a change", "if (!gate._changing)", "if (true)"),
    # The session
    session("writes go on while it joins", "const UseGate::Change change(_shared->Gate);", ""),
    session("topics of a session that ended stay", "_shared->Topics->ForgetRemote();", ""),
    session("a peer is lost once", "for (int i = 0; i < count && _onPeer; ++i)", "if (_onPeer)"),
    session("a peer that left is lost too", "else if (--_peers[peer] <= 0)", "else if (false)"),
    session("a failure is not told", "if (_failure)", "if (false)"),
    session("a failure is told for ever", "_failure.reset();", ""),
    session("after a failure it tries again at once", "_decision.Failed(_host.Now());", ""),
    session("a bad file is found too late", "_backend->CheckConfig(_settings); return;", "return;"),
    session("half a session stays", "CloseAll(); throw;", "throw;"),
    session("nobody looks for an address again", "current.Settings.Peers.size() < _settings.Peers.size()", "false"),
    session("a peer's port is lost", "if (parsed.Port != 0)", "if (false)"),
    session("an address that another host has is kept", "if (_backend->IsMisledByDuplicates() && !_hasOwnNetworks)",
            "if (false)"),
    session("it is left out for nothing", "if (_backend->IsMisledByDuplicates() && !_hasOwnNetworks)",
            "if (!_hasOwnNetworks)"),
    session("the vendor finds what was named", "(_settings.Interfaces.empty() && _backend->FindsNetworks())",
            "_backend->FindsNetworks()"),
    session("it waits for what the file replaces", "settings.Interfaces.clear();", ""),
    # Names of peers
    resolver("what is known is looked up again",
             "return address && shared->Addresses.emplace(host, *address).second;",
             "if (address) { shared->Addresses.emplace(host, *address); } return false;"),
    resolver("the first answers are not waited for",
             "_shared->Event.wait_for(lock, firstWait, [this] { return _shared->Tried; });", ""),
]
