// Bounds the costs of participants that are strangers: what each of them, those of one host, and all of them
// together make this node keep and send.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/AuthorityRefusals.h"
#include "common/Rtps.h"

namespace Rabit::Rtps
{

// An address and a port at which a participant says that it can be reached.
struct Place
{
    HostAddress Host{};
    std::uint16_t Port = 0;
    auto operator<=>(const Place &) const = default;
};

// Anybody can announce participants that do not exist. Each would be kept, and would get a copy of each
// sample, until its lease ends. So a participant is a *stranger* until it has spoken: until one of its own
// endpoints has sent a sample, a heartbeat or an acknowledgement. The nodes of a fleet speak as soon as they
// have met. Of the programs that only listen, the first few that have acknowledged our announcements are no
// strangers either. In a fleet with keys a member is no stranger once it is announced with the name in its
// certificate.
//
// - Strangers are few, and have few endpoints, for each host and in all.
// - A stranger is sent as many bytes as came from it. All strangers share a small allowance besides. Those of
//   hosts that are listed as peers are sent all. Samples may have half of both: a stranger that needs nothing
//   but our discovery to become known would never get it beside samples that come each moment.
// - Each participant has a limit of endpoints, and all participants together have one.
//
// Nothing here follows a number that somebody sent. An account exists as long as the DDS implementation knows
// the participant: the guard opens and closes it, and the session closes it when the implementation has lost
// the participant. Thread-safe; calls nothing.
class Ledger
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // Participants.
    static constexpr std::size_t Most = 1024;
    static constexpr std::size_t MostStrangers = 256;
    static constexpr std::size_t MostStrangersOfHost = 32;
    // Endpoints.
    static constexpr std::size_t MostEndpoints = 16384;
    static constexpr std::size_t MostEndpointsOfOne = 1024;
    static constexpr std::size_t MostEndpointsOfStrangers = 2048;
    static constexpr std::size_t MostEndpointsOfHost = 512;  // if they are strangers
    // Programs that only listen and are sent all samples.
    static constexpr std::size_t MostListeners = 8;
    // Places of one participant that are known. It is a stranger at others.
    static constexpr std::size_t MostPlaces = 16;
    // Bytes that may go to strangers without any from them: at once, and for each second.
    static constexpr std::int64_t Allowance = 16'384;
    static constexpr std::int64_t AllowanceRate = 512;
    // Most bytes that one stranger can save up.
    static constexpr std::int64_t LargestCredit = 65'536;

    // The hosts that the settings list as peers.
    explicit Ledger(std::set<HostAddress> listed = {}) : _listed(std::move(listed)) {}

    enum class Coming
    {
        Refused,  // it is new, and there are too many
        New,
        Known
    };
    // A participant announced itself, in a datagram of so many bytes from `host`. Opens its account.
    Coming Comes(const GuidPrefix &peer, const HostAddress &host, std::size_t bytes, TimePoint now);
    // The places that the participant names. If they have changed, the former ones are forgotten, and those
    // of its endpoints.
    void SetPlaces(const GuidPrefix &peer, std::span<const Place> places);
    // A participant announced an endpoint. Returns false if the endpoint is new, and there are too many; also
    // if the participant has no account. `places`: those that the endpoint names.
    bool HasEndpoint(const GuidPrefix &peer, EntityId endpoint, std::span<const Place> places, TimePoint now);
    void EndpointGone(const GuidPrefix &peer, EntityId endpoint);
    // The participant has left, or the implementation has lost it.
    void Left(const GuidPrefix &peer);

    // A datagram came from the participant.
    void Came(const GuidPrefix &peer, std::size_t bytes);
    // One of the participant's own endpoints sent something. Returns true the first time.
    bool Spoke(const GuidPrefix &peer);
    // The participant acknowledged announcements of ours.
    void Listens(const GuidPrefix &peer);
    bool IsStranger(const GuidPrefix &peer) const;

    enum class Going
    {
        Refused,
        // To a stranger. Hold it back while the kernel asks for the host's hardware address: it keeps such
        // datagrams at the expense of the socket's buffer. A full buffer blocks the socket for some seconds.
        AsToStranger,
        Freely
    };
    enum class Cargo
    {
        Discovery,
        Samples  // and all else that endpoints of users send
    };
    // Whether a datagram of so many bytes may go to that place, which is then charged. At a place that nobody
    // has announced there is a stranger, unless the host is listed: Cyclone DDS announces its participant at
    // each address at which it has ever heard another one. Headers of IP and UDP are counted besides, here
    // and in Came.
    Going MayGo(const Place &to, std::size_t bytes, Cargo cargo, TimePoint now);

    // A host whose participants were refused something in each of the last seconds.
    struct Refused
    {
        HostAddress Host{};
        std::uint64_t Times = 0;
        // For a person: "10.0.0.9".
        std::string Address() const;
    };
    // Hosts that were refused something in LastingSeconds different seconds, without a pause of Pause.
    static constexpr int LastingSeconds = 10;
    static constexpr std::chrono::seconds Pause{10};
    std::vector<Refused> LastingRefusals(TimePoint now) const;
    std::uint64_t Refusals() const;

    // Announcements that certificates do not allow. Entries end with their endpoints and accounts.
    AuthorityRefusals &OfAuthority() { return _ofAuthority; }

private:
    static constexpr std::size_t MostHosts = 64;  // of Refusal
    static constexpr std::size_t IpAndUdp = 28;

    struct Account
    {
        HostAddress Host{};
        bool IsListed = false;
        bool HasSpoken = false;
        bool Listens = false;  // and is one of the first that do
        std::int64_t Credit = 0;
        std::int64_t ForSamples = 0;  // of these
        void Add(std::int64_t bytes)
        {
            Credit = std::min(Credit + bytes, LargestCredit);
            ForSamples = std::min(ForSamples + bytes / 2, LargestCredit / 2);
        }
        bool Has(std::int64_t bytes, Cargo cargo) const
        {
            return Credit >= bytes && (cargo == Cargo::Discovery || ForSamples >= bytes);
        }
        void Take(std::int64_t bytes, Cargo cargo)
        {
            Credit -= bytes;
            ForSamples -= cargo == Cargo::Samples ? bytes : 0;
        }
        std::set<EntityId> Endpoints;
        std::vector<Place> Named;   // by the participant
        std::vector<Place> Places;  // all of them
        bool IsStranger() const { return !HasSpoken && !Listens; }
    };
    struct Refusal
    {
        std::uint64_t Times = 0;
        int Seconds = 0;  // different ones
        TimePoint Last{};
    };
    struct Sum
    {
        std::size_t Participants = 0;
        std::size_t Endpoints = 0;
        std::size_t OfHost = 0;
        std::size_t EndpointsOfHost = 0;
    };

    Sum StrangersBeside(const HostAddress &host) const;
    void PutPlaces(const GuidPrefix &peer, Account &account, std::span<const Place> places);
    void RemovePlaces(const GuidPrefix &peer, const Account &account);
    void Refuse(const HostAddress &host, TimePoint now);
    bool TakeAllowance(std::int64_t bytes, Cargo cargo, TimePoint now);

    const std::set<HostAddress> _listed;
    mutable std::mutex _mutex;
    std::map<GuidPrefix, Account> _accounts;
    std::set<std::pair<Place, GuidPrefix>> _places;
    std::size_t _endpoints = 0;
    std::size_t _listeners = 0;
    std::int64_t _allowance = Allowance;
    TimePoint _filledAt{};
    std::map<HostAddress, Refusal> _refused;
    std::uint64_t _refusals = 0;
    AuthorityRefusals _ofAuthority;  // has a lock of its own
};

}  // namespace Rabit::Rtps
