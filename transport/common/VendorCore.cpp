#include "common/VendorCore.h"

#include <arpa/inet.h>

#include <set>
#include <utility>

#include "common/PeerAddress.h"
#include "common/RtpsReader.h"

namespace Rabit
{

namespace
{

// `peers`: addresses (RejoiningBackend::Open).
std::set<Rtps::HostAddress> HostsOf(const std::vector<std::string> &peers)
{
    std::set<Rtps::HostAddress> hosts;
    for (const std::string &peer : peers)
    {
        Rtps::HostAddress host{};
        if (inet_pton(AF_INET, ParsePeer(peer).Host.c_str(), host.data()) == 1)
        {
            hosts.insert(host);
        }
    }
    return hosts;
}

}  // namespace

VendorCore::VendorCore(const TransportSettings &settings, const SessionContext &context)
    : _context(context),
      _accounts(std::make_shared<Rtps::Ledger>(HostsOf(settings.Peers))),
      _peerGate(context.Log, "peer events")
{
}

void VendorCore::Close()
{
    _closed = true;
    _peerGate.Close();
}

std::shared_ptr<const PeerSession> VendorCore::IdentityOf(const WriterId &endpoint) const
{
    const Rtps::GuidPrefix participant = Rtps::PrefixOf(endpoint);
    const std::lock_guard lock(_mutex);
    if (Identity known = _peers.Find(participant))
    {
        return known;
    }
    const Identity *const gone = _gone.Find(participant);
    return gone == nullptr ? nullptr : *gone;
}

std::vector<PeerPlace> VendorCore::PeerPlaces() const
{
    const std::lock_guard lock(_mutex);
    std::vector<PeerPlace> places;
    for (const auto &[participant, place] : _places)
    {
        places.push_back(place);
    }
    return places;
}

std::vector<SettingsProblem> VendorCore::Problems() const
{
    std::vector<SettingsProblem> problems;
    const auto now = std::chrono::steady_clock::now();
    for (const Rtps::Ledger::Refused &refused : _accounts->LastingRefusals(now))
    {
        problems.push_back(
            {.Setting = "stranger",
             .Entry = refused.Address(),
             .Text = "programs there announce or request more than this node gives to strangers: "
                     "refused " +
                     std::to_string(refused.Times) + " times"});
    }
    for (Rtps::AuthorityRefusals::Row &row : _accounts->OfAuthority().LastingRefusals(now))
    {
        problems.push_back(
            {.Setting = "security", .Entry = std::move(row.Node), .Text = std::move(row.Text)});
    }
    if (auto problem = MeetingProblem())
    {
        problems.push_back(std::move(*problem));
    }
    return problems;
}

void VendorCore::Appeared(const Rtps::GuidPrefix &participant, const ParticipantIdentity &who,
                          const PeerPlace &place)
{
    Identity identity;
    {
        const std::lock_guard lock(_mutex);
        identity = _goodbyes->Has(participant, std::chrono::steady_clock::now())
                       ? nullptr
                       : _peers.Add(participant, who);
        if (identity == nullptr)
        {
            return;
        }
        _places.insert_or_assign(participant, place);
    }
    Tell(PeerEvent::Kind::Appeared, identity);
}

void VendorCore::Gone(const Rtps::GuidPrefix &participant, PeerEvent::Kind how)
{
    Identity identity;
    {
        const std::lock_guard lock(_mutex);
        identity = _peers.Remove(participant);
        if (identity == nullptr)
        {
            return;
        }
        _places.erase(participant);
        _gone.Put(participant, identity);
    }
    Tell(how, identity);
}

void VendorCore::Tell(PeerEvent::Kind what, const Identity &who)
{
    Run([this, what, who] { _peerGate.Run([&] { _context.OnPeer({what, who->Node, who->Incarnation}); }); });
}

}  // namespace Rabit
