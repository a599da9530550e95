#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimMessages.h"

namespace Rabit
{

// A voter: grants each claim to one claimant at a time, and keeps it while that one renews its lease. This is
// the lease of Gray and Cheriton (1989) with a fencing number, as in Chubby (Burrows 2006); a majority of
// voters makes it a PaxosLease (Trencseni et al. 2012).
//
// - The record of a claimant's session is a *book*. It ends when no renewal has come for
//   AgreementSettings::VotersLease, and takes all of its grants with it. Two incarnations of one name have
//   two books, since the former one may still run.
// - Grants live in memory. So a voter that starts abstains for as long: its former life may have granted
//   anything. Only the highest fence is stored, in blocks, before it is used: a request with a higher one is
//   answered once that is stored, which is up to the caller.
// - It abstains while another live node has its name, since both would vote.
//
// A pure state machine. Time is passed in: that of a clock that runs on while the computer is suspended. Not
// thread-safe.
class ClaimBallots
{
public:
    using Duration = AgreementSettings::Duration;

    // Books of one name: its present incarnation, and former ones that may still run.
    static constexpr std::size_t MostBooksOfOne = 4;
    // Fences that are stored ahead, so that not each claim waits for a disk.
    static constexpr std::uint64_t FencesAhead = 1024;
    // How far a fence may be above all that this voter knows: a voter that lost its storage knows none. A
    // member that leaps again and again needs 16 million requests to use all fences up.
    static constexpr std::uint64_t LargestLeap = std::uint64_t{1} << 40;

    // The settings must outlive the object. `fences`: all up to this one may have been accepted. `now`:
    // abstains for VotersLease from here on.
    ClaimBallots(const AgreementSettings &settings, std::uint64_t fences, Duration now);

    // Returns the answer. Empty: this voter says nothing. It abstains, or the claimant is not in the list,
    // has another list or lease, is a former life of one that is known, or has too many books. Or `waits`:
    // the request has a fence that must be stored first, and is to be taken again after Stored.
    std::optional<ClaimReply> OnRequest(std::string_view from, const ClaimRequest &request, Duration now,
                                        bool *waits = nullptr);

    // The fence that must be stored; empty: none must.
    std::optional<std::uint64_t> StoreWanted() const
    {
        return _storeWanted > _stored ? std::optional(_storeWanted) : std::nullopt;
    }
    // All fences up to this one are stored. Or they could not be: until they are, higher ones are refused.
    void Stored(std::uint64_t upTo, bool isStored)
    {
        _stored = isStored ? std::max(_stored, upTo) : _stored;
        _cannotStore = !isStored;
    }

    // Another live node has this node's name.
    void NameIsTaken(Duration now) { _votesFrom = now + _settings.VotersLease(); }

    // The holder of a claim, as far as this voter knows: others may have granted it to another one.
    struct Holding
    {
        std::string Holder;
        std::uint64_t Fence = 0;  // 0: granted, not accepted yet
        Duration Until{0};        // if it is not renewed
    };
    std::optional<Holding> HolderOf(std::string_view claim, Duration now) const;

private:
    struct Book
    {
        std::string Claimant;
        std::uint64_t Incarnation = 0;
        std::uint32_t Session = 0;
        std::uint32_t Renewal = 0;
        std::uint32_t Number = 0;  // of the last orders
        std::size_t Grants = 0;
        Duration Until{0};
    };
    struct Grant
    {
        std::uint64_t Book = 0;
        std::uint64_t Fence = 0;
    };
    using Books = std::map<std::uint64_t, Book>;
    using Grants = std::map<std::string, Grant, std::less<>>;

    void EndBooks(Duration now);
    Books::iterator BookOf(std::string_view from, const ClaimRequest &request, Duration now);
    ClaimResult Obey(const ClaimOrder &order, Books::value_type &book, Duration now);
    ClaimResult Ask(const ClaimOrder &order, Books::value_type &book, Duration now);
    ClaimResult RefusedFor(const std::string &claim, const Grant *grant, Duration now) const;
    bool IsLeap(std::uint64_t fence) const { return fence > _fences && fence - _fences > LargestLeap; }
    // Notes the fences of the request that must be stored. Returns true if it has to wait for that.
    bool MustStore(const ClaimRequest &request);
    bool Raise(std::uint64_t fence);

    const AgreementSettings &_settings;
    const std::uint64_t _group;
    std::uint64_t _fences;
    std::uint64_t _stored;
    std::uint64_t _storeWanted = 0;
    bool _cannotStore = false;
    Duration _votesFrom;
    std::uint64_t _lastBook = 0;
    Books _books;
    Grants _grants;
    Duration _firstEnd = Duration::max();  // no book ends before
};

}  // namespace Rabit
