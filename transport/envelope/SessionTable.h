#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/RecentMap.h"
#include "envelope/Session.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

enum class ClaimVerdict : std::uint8_t
{
    Added,   // a session that is not proven yet
    Known,   // the session was there; nothing changed
    Proven,  // the sender has shown that it is live
    // Refused. The holder is the certificate of the claim that was first.
    OtherHeaders,  // the session was claimed with other RTPS headers
    TagTaken,      // another session has this tag
    PrefixTaken,   // another certificate has proven that it speaks for one of the GUID prefixes
    TooMany        // all places are taken by sessions that may not be ended for this one
};

// The sessions that may speak on one path. A session gets a place by a claim that was verified, and is proven
// by a claim that answers this node's nonce. The first proven claim of a GUID prefix holds as long as its
// session has a place. Bounded. Pointers to sessions hold until the next Take or End. Time is passed in. Not
// thread-safe: the lock of opening guards the table and its sessions.
class SessionTable
{
public:
    // Sessions of one certificate: several paths, and some that have ended without a word. Of more, the one
    // that was silent for longest is ended.
    static constexpr std::size_t MostProvenOfOne = 8;
    // Recorded claims make such sessions. They displace each other, never a proven one.
    static constexpr std::size_t MostUnprovenOfOne = 4;
    static constexpr std::size_t Most = 2048;
    // If the table is full, a proven session that was silent for longer makes room for one that is live.
    // Longer than a battery or a flight behind a hill.
    static constexpr std::chrono::hours HoldsFor{1};
    // Sessions that made room for others, whose highest numbers are kept: recorded claims of them are
    // refused.
    static constexpr std::size_t MostDisplaced = 1024;

    struct Facts
    {
        End Sender;
        std::shared_ptr<KnownCertificate> Certificate;
        std::vector<RtpsHeader> Headers;
        std::uint64_t Number = 0;         // of the claim's datagram
        std::optional<TimePoint> LiveAt;  // OwnChallenges::AnsweredBy
    };
    struct Result
    {
        ClaimVerdict Verdict = ClaimVerdict::TooMany;
        Session *Of = nullptr;  // null if the claim was refused
        std::string Holder{};   // name in the certificate whose claim was first; only if this one was refused
    };

    // `self`: this node, whose prefixes nobody else gets.
    SessionTable(const End &self, std::string name, std::span<const RtpsHeader> headers);

    // Null if there is no session with that tag.
    Session *Find(SessionTag tag) const;
    // `facts` must be those of a claim whose certificate and signature were verified.
    Result Take(const Facts &facts, TimePoint now);
    // True if the number is not above those that a displaced session had. So its claim is a recording.
    bool WasTaken(const End &sender, std::uint64_t number) const;
    // Ends the sessions of revoked certificates.
    void EndRevoked(const EpochSecrets &epochs);

    // The certificate with that hash, if one of the sessions has it; else null.
    std::shared_ptr<KnownCertificate> CertificateOf(const Hash &hash) const;
    std::size_t Size() const { return _sessions.size(); }
    // Calls visit(session) for each session.
    template <typename Visit>
    void VisitAll(const Visit &visit) const
    {
        for (const auto &[tag, session] : _sessions)
        {
            visit(*session);
        }
    }

private:
    using Map = std::unordered_map<SessionTag, std::unique_ptr<Session>>;

    static bool Holds(const Session &session, TimePoint now);
    static bool BindsAnyOf(const Session &session, const Facts &facts);
    const std::string *HolderOf(const Facts &facts) const;
    bool MakeRoom(const Facts &facts, const Session *known, TimePoint now);
    // Ends a session and keeps its highest number.
    void Displace(Map::iterator which);
    template <typename Fits>
    Map::iterator LongestSilent(const Fits &fits);

    End _self;
    SessionTag _ownTag;
    std::string _name;
    std::vector<Rtps::GuidPrefix> _ownPrefixes;
    Map _sessions;
    RecentMap<End, std::uint64_t> _displaced{MostDisplaced};
};

}  // namespace Rabit::Envelope
