// Stands between the network and the vendor's parser, which trusts its input.
//
// Debian builds Fast DDS with its assertions on, so a datagram that violates one ends the process. Others
// make it allocate gigabytes, or walk through numbers for hours with its locks held. Cyclone DDS checks more,
// but one forged number far ahead silences a writer for it until one of the two is restarted.
#pragma once

#include <rabit/base/Assert.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/HardwareAddresses.h"
#include "common/Ledger.h"
#include "common/RecentGoodbyes.h"
#include "guard/AnnouncementReplies.h"
#include "guard/AuthorityCheck.h"
#include "guard/DeliveryCheck.h"
#include "guard/DiscoveryFragments.h"
#include "guard/KnownPeers.h"
#include "guard/PeerObserver.h"
#include "guard/RtpsMessage.h"
#include "guard/SentFragments.h"
#include "guard/WalkBudget.h"

namespace Rabit::Rtps
{

struct Announcement;

// Admits only data that is sound in itself (RtpsMessage, DeliveryCheck, DiscoveryCheck) and agrees with what
// its sender has sent before (KnownPeers, SentFragments). A careful forger of a neighbour's datagrams can
// still harm its streams, though not the process: only the seal (envelope/SealedSession.h) prevents that.
// Thread-safe.
class RtpsGuard
{
public:
    enum class Mode
    {
        Full,
        // Checks each datagram by itself only: peers' announcements may come another way, by shared memory.
        StructureOnly
    };

    using TimePoint = KnownPeers::TimePoint;
    using Authority = Rtps::Authority;
    // It may change the bytes.
    using Deliver = std::function<void(std::span<std::uint8_t>)>;

    // Fast DDS reads past the end of a sample if a fragment is requested that it has not, and walks through
    // all numbers that are declared absent. For it both are compared with what was sent, so the guard must be
    // told of all that is sent.
    enum class Vendor
    {
        FastDds,
        CycloneDds
    };

    // `period`: announcement period of all participants. `goodbyes`: where to note those of known
    // participants. `ledger`: where to keep the accounts of participants, in Mode::Full. A session behind the
    // guard shares both.
    RtpsGuard(Mode mode, std::chrono::milliseconds period, Vendor vendor = Vendor::FastDds,
              std::shared_ptr<RecentGoodbyes> goodbyes = std::make_shared<RecentGoodbyes>(),
              std::shared_ptr<Ledger> ledger = std::make_shared<Ledger>())
        : _mode(mode),
          _vendor(vendor),
          _goodbyes(std::move(goodbyes)),
          _ledger(std::move(ledger)),
          _replies(period)
    {
    }

    // Sets the observer of participants, which must outlive the guard. Call before anything is admitted. With
    // an observer, announcements of participants that have a card are not delivered: the observer sees to it
    // that the vendor learns of them.
    void SetObserver(PeerObserver &observer) { _observer = &observer; }
    // Sets what the certificates of participants say. An announcement that they do not allow is then refused,
    // whether it comes from the network or in a card. A participant without a known certificate is ignored.
    // For Mode::Full; as for SetObserver.
    void SetAuthority(Authority authority)
    {
        RABIT_ASSERT(_mode == Mode::Full);
        _authority.emplace(std::move(authority), _ledger);
    }
    // Takes note of a card message. True if its sender's announcement was admitted and names that address.
    bool IsKnownAt(std::span<const std::uint8_t> cardMessage, const HostAddress &from);
    // When a participant was last heard; empty: its announcement has not been admitted.
    std::optional<TimePoint> LastHeard(const GuidPrefix &peer);
    // True if a participant at that address was heard since then, and all that were listen to the group.
    bool GroupReaches(const HostAddress &host, TimePoint since);

    // Source of a datagram.
    enum class Origin
    {
        Network,
        Card  // replays a card, in the name of the participant whose card it is
    };

    // Delivers the part of a datagram that the vendor may see: all, some, or nothing. Parts that it must not
    // see are blanked in place. The counts by which it detects repeated announcements and heartbeats are
    // replaced. `from`: source address. Returns false if something was kept back that an honest sender does
    // not send.
    bool Admit(std::span<std::uint8_t> datagram, const HostAddress &from, TimePoint now,
               const Deliver &deliver, Origin origin = Origin::Network);

    // Records a datagram that we send.
    void Sending(std::span<const std::uint8_t> datagram);
    // True if a datagram may go to that address, which is not a group's (Ledger::MayGo). To a stranger it
    // does not go while the kernel awaits the hardware address, but for one a second.
    bool MayGo(const Place &to, std::size_t bytes, Ledger::Cargo cargo, HardwareAddresses &addresses,
               TimePoint now)
    {
        const auto going =
            _mode == Mode::Full ? _ledger->MayGo(to, bytes, cargo, now) : Ledger::Going::Freely;
        return going == Ledger::Going::Freely ||
               (going == Ledger::Going::AsToStranger && addresses.MayAsk(to.Host, now));
    }

    // True, once, if a peer of whom a datagram was admitted waits for our announcement.
    bool TakeReplyDue() { return _replyDue.exchange(false); }

    // Number of admitted announcements of other participants.
    std::uint64_t AnnouncementsHeard() const { return _announcementsHeard; }

private:
    enum class Verdict
    {
        Pass,
        Ignore,  // blanked: we do not use it
        Refuse,  // blanked and counted
        Forbid,  // counted, and replaced by a GAP: the vendor waits for no number of a reliable writer
        Drop     // refuse the whole datagram, and count it
    };

    // State of the datagram being checked. Used under _mutex.
    struct Passage
    {
        std::span<std::uint8_t> Datagram;
        // Header of a message with only the submessages of the current sender.
        std::array<std::uint8_t, RtpsHeaderSize> Header{};
        GuidPrefix Sender{};
        GuidPrefix Destination{};
        HostAddress From{};
        Origin Whence = Origin::Network;
        std::uint64_t Stamp = 0;  // INFO_TS; 0: none
        TimePoint Now{};
        bool Useful = false;
        bool Honest = true;
        // Announcements completed by their last fragment here, and ends that got a key hash (KeyedEnd.h), as
        // messages of their own.
        std::vector<std::vector<std::uint8_t>> Whole;
    };

    // Returns the remaining datagram; empty if nothing remains.
    std::span<std::uint8_t> Filter(Passage &passage);
    Verdict Judge(const Submessage &submessage, Passage &passage);
    bool IsForOthers(const Passage &passage) const;
    // True if the observer handles this instead of the network.
    bool IsReplayed(const Delivery &delivery, const Passage &passage) const;
    // True if the ledger counts what comes from the sender.
    bool IsCounted(const Passage &passage) const { return _mode == Mode::Full && passage.Sender != _own; }
    void NoteVoice(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    // The participant is no stranger any more.
    void NoteSpoken(const GuidPrefix &peer);
    Verdict JudgeEndpoint(const Announcement &announcement, EntityId writer, const Passage &passage);
    void NoteEnd(const Delivery &delivery, EntityId subject, const Passage &passage);
    void NoteGoodbye(const Passage &passage);
    Verdict JudgeParticipant(const Announcement &announcement, const Passage &passage);
    Verdict JudgeDelivery(const Submessage &submessage, const Delivery &delivery, Passage &passage);
    Verdict JudgeBuiltinSample(const Submessage &submessage, const Delivery &delivery, Passage &passage);
    // True if the discovery data comes from the participant in whose name it is, as far as an address tells.
    bool IsItsOwn(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    // Compares with what was sent before.
    Verdict Compare(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    // Cuts the range of absent numbers in a heartbeat or a gap, for a vendor that walks through it.
    Verdict CutAbsent(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    void ReplaceNumber(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    void ReplaceAnnouncement(const Submessage &submessage, const Delivery &delivery,
                             const GuidPrefix &sender);
    void ReplaceCount(const Submessage &submessage, const Delivery &delivery, const GuidPrefix &sender);

    const Mode _mode;
    const Vendor _vendor;
    const std::shared_ptr<RecentGoodbyes> _goodbyes;
    const std::shared_ptr<Ledger> _ledger;
    PeerObserver *_observer = nullptr;
    std::optional<AuthorityCheck> _authority;
    std::mutex _mutex;              // several sockets receive at once
    KnownPeers _peers;              // guarded by _mutex
    WalkBudget _walk;               // guarded by _mutex
    SentFragments _sent;            // guarded by _mutex
    DiscoveryFragments _fragments;  // guarded by _mutex
    AnnouncementReplies _replies;   // guarded by _mutex
    GuidPrefix _own{};              // set once we have sent; guarded by _mutex
    std::atomic<bool> _replyDue{false};
    std::atomic<std::uint64_t> _announcementsHeard{0};
};

}  // namespace Rabit::Rtps
