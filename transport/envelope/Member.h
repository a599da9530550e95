#pragma once

#include <rabit/transport/FleetMember.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/RecentMap.h"
#include "envelope/Bulletin.h"
#include "envelope/Certificate.h"
#include "envelope/EpochSecrets.h"
#include "envelope/LastingProblems.h"
#include "envelope/Permissions.h"
#include "envelope/SecretKey.h"
#include "envelope/Self.h"
#include "envelope/VerifyingKey.h"

namespace Rabit::Envelope
{

// This node as a member: its keys, the epochs that it knows, and what all of its sessions share. Thread-safe:
// while MemberKeys::Store runs, Learn alone waits.
class Member final : public FleetMember
{
public:
    struct Clocks
    {
        std::function<TimePoint()> Steady;
        std::function<std::int64_t()> Utc;  // seconds since 1970; for warnings alone
    };
    using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

    // Lists of permissions that are kept, and names in Problems.
    static constexpr std::size_t MostLists = 1024;
    static constexpr std::size_t MostNames = 1024;
    // Rows of NoteCertain.
    static constexpr std::size_t MostCertain = 64;

    struct Made
    {
        std::shared_ptr<Member> Of;
        std::string Error;
    };
    // As MakeFleetMember. Overwrites the secrets in `keys`, once they are in the member.
    static Made Make(MemberKeys &&keys, Clocks clocks);

    const std::string &Name() const override { return _certificate.Name; }
    std::vector<SettingsProblem> Problems() const override;

    const Envelope::Certificate &Certificate() const { return _certificate; }
    const PublicKey &Authority() const { return _authorityKey; }
    // Empty if OpenSSL fails.
    std::optional<Self> SelfIn(const SessionId &session, std::vector<RtpsHeader> headers) const;
    // The own list of permissions.
    const Bytes &OwnList() const { return _list; }

    // Changes whenever Epochs does.
    std::uint64_t EpochsVersion() const { return _version.load(std::memory_order_acquire); }
    EpochSecrets Epochs() const;
    struct NewestBulletin
    {
        Hash Of{};
        Bytes Content;
    };
    NewestBulletin Newest() const;
    // True if this is the hash of a bulletin that is known, or was refused.
    bool KnowsBulletin(const Hash &hash) const;
    // Takes a bulletin of any origin: verifies, stores, and uses it. Returns a line for the log; empty if it
    // was not new. May wait for the disk.
    std::string Learn(std::vector<std::uint8_t> bulletin);

    // Null: the list is not known.
    std::shared_ptr<const Permissions> ListOf(const Hash &hash) const;
    // Takes a list whose hash is right. Returns false if it is none.
    bool AddList(const Hash &hash, std::span<const std::uint8_t> bytes);

    // Something goes wrong with that node or address: a row of Problems if it lasts.
    void Note(const std::string &entry, const std::string &text, TimePoint now,
              ProblemKind kind = ProblemKind::Usual);
    // A row from now on.
    // Returns true if the entry had no such row.
    bool NoteCertain(const std::string &entry, const std::string &text);
    // A certificate has proven itself.
    void NoteCertificate(const Envelope::Certificate &certificate);

private:
    Member(MemberKeys &&keys, Clocks clocks, VerifyingKey authority, AgreementKey agreement);

    // These two return an error for people, or nothing. No other thread has the member yet.
    std::string TakeKeys();
    std::string TakeStored(const std::vector<std::vector<std::uint8_t>> &bulletins);
    // Puts a bulletin to use that this node can open. Requires _mutex.
    void Use(const Envelope::Bulletin &read, const SecretKey &secret, Bytes content, TimePoint now);
    void AppendDates(std::vector<SettingsProblem> &rows) const;

    const Clocks _clocks;
    const SecretKey _signing;
    const SecretKey _agreementBytes;
    const PublicKey _authorityKey;
    const std::vector<std::uint8_t> _certificateBytes;
    const std::function<bool(std::uint16_t, std::span<const std::uint8_t>)> _store;
    const AgreementKey _agreement;
    Envelope::Certificate _certificate;  // constant once made, as the next one
    Bytes _list;

    std::mutex _learning;     // one bulletin at a time; locked before _mutex
    VerifyingKey _authority;  // guarded by _learning

    mutable std::mutex _mutex;  // guards all below
    EpochSecrets _epochs;
    std::atomic<std::uint64_t> _version = 0;
    NewestBulletin _bulletin;
    std::set<Hash> _bulletins;  // hashes of those that were learned
    RecentMap<Hash, bool> _refused{64};
    RecentMap<Hash, std::shared_ptr<const Permissions>> _lists{MostLists};
    LastingProblems _lasting;
    std::map<std::string, std::string> _certain;  // by entry
    struct Named
    {
        std::uint32_t Begins = 0;
        std::uint32_t Ends = 0;
    };
    std::map<std::string, Named> _named;  // certificates, by name
};

}  // namespace Rabit::Envelope
