// Stands between the network and the vendor's parser, which trusts what it reads.
//
// Debian builds Fast DDS with its assertions on, so a datagram that breaks one ends the process; and others
// have it allocate gigabytes, or walk through numbers for hours with its locks held. Cyclone DDS looks
// closer, but one forged number far ahead silences a writer for it until one of the two is started again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "guard/AnnouncementReplies.h"
#include "guard/DeliveryCheck.h"
#include "guard/DiscoveryFragments.h"
#include "guard/KnownPeers.h"
#include "guard/PeerObserver.h"
#include "guard/RtpsMessage.h"
#include "guard/SentFragments.h"

namespace Rabit::Rtps
{

struct Announcement;

// What is let through is sound in itself (RtpsMessage, DeliveryCheck, DiscoveryCheck) and agrees with what
// its sender has said before (KnownPeers, SentFragments). Whoever forges a neighbour's datagrams with care
// still does harm to its streams, though not to the process: that is a matter for DDS Security. Thread-safe.
class RtpsGuard
{
public:
    enum class Mode
    {
        Full,
        // Only what a datagram shows by itself is checked: what peers say of themselves may come another way,
        // by shared memory.
        StructureOnly,
        // As StructureOnly, and what DDS Security needs gets through as it is, if it is sound.
        Secured,
        // As Secured, where nothing is said without protection but who is there, and handshakes.
        Protected
    };

    using TimePoint = KnownPeers::TimePoint;
    // It may change what it is given.
    using Deliver = std::function<void(std::span<std::uint8_t>)>;

    // Whether requests for fragments are held against what was sent, for a vendor that would read past the
    // end of a sample. The guard must be told of all that is sent then.
    enum class Requests
    {
        Checked,
        AsTheyCome
    };

    // The period in which all announce themselves.
    RtpsGuard(Mode mode, std::chrono::milliseconds period, Requests requests = Requests::Checked)
        : _mode(mode), _requests(requests), _replies(period)
    {
    }

    // Tells the observer, which must outlive the guard, of participants. Before anything is admitted. With an
    // observer, announcements of participants that have a card are not handed on: the observer sees to it
    // that the vendor is told of them.
    void SetObserver(PeerObserver &observer) { _observer = &observer; }
    // Whether a participant whose announcement was admitted has said that it is at that address.
    bool IsKnownAt(const GuidPrefix &peer, const HostAddress &from);
    // When a participant was heard last; empty: its announcement has not been admitted.
    std::optional<TimePoint> LastHeard(const GuidPrefix &peer);
    // True if a participant at that address was heard since then, and all that were listen to the group.
    bool GroupReaches(const HostAddress &host, TimePoint since);

    // Where a datagram comes from.
    enum class Origin
    {
        Network,
        Card  // it says what a card says, in the name of the participant whose card it is
    };

    // Hands on what of a datagram the vendor may see: all, a part, or nothing. Parts that it must not see are
    // blanked in place, and the counts that it tells repeats of announcements and heartbeats by are replaced.
    // `from` is whence it came. Returns false if something was kept back that an honest sender does not send.
    bool Admit(std::span<std::uint8_t> datagram, const HostAddress &from, TimePoint now,
               const Deliver &deliver, Origin origin = Origin::Network);

    // Takes note of what we send.
    void Sending(std::span<const std::uint8_t> datagram);

    // Whether somebody of whom a datagram was admitted waits for our announcement. Says so once.
    bool TakeReplyDue() { return _replyDue.exchange(false); }

    // How many announcements of other participants were admitted.
    std::uint64_t AnnouncementsHeard() const { return _announcementsHeard; }

private:
    enum class Verdict
    {
        Pass,
        Ignore,  // of no use to us: blanked
        Refuse,  // blanked and counted
        Drop     // the whole datagram, and counted
    };

    // One datagram under way. Holds _mutex.
    struct Passage
    {
        std::span<std::uint8_t> Datagram;
        // As if who speaks now had sent it alone.
        std::array<std::uint8_t, RtpsHeaderSize> Header{};
        GuidPrefix Sender{};
        GuidPrefix Destination{};
        HostAddress From{};
        Origin Whence = Origin::Network;
        std::uint64_t Stamp = 0;  // INFO_TS; 0: none
        TimePoint Now{};
        bool Useful = false;
        bool Honest = true;
        // Announcements whose last fragment came, as messages of their own.
        std::vector<std::vector<std::uint8_t>> Whole;
    };

    bool IsSecured() const { return _mode == Mode::Secured || _mode == Mode::Protected; }
    // What is left of the datagram; empty if nothing.
    std::span<std::uint8_t> Filter(Passage &passage);
    Verdict Judge(const Submessage &submessage, Passage &passage);
    bool IsForOthers(const Passage &passage) const;
    // Whether the observer sees to this instead of the network.
    bool IsReplayed(const Delivery &delivery, const Passage &passage) const;
    Verdict JudgeParticipant(const Announcement &announcement, const Passage &passage);
    Verdict JudgeDelivery(const Submessage &submessage, const Delivery &delivery, Passage &passage);
    Verdict JudgeBuiltinSample(const Submessage &submessage, const Delivery &delivery, Passage &passage);
    // Whether what is said of discovery comes from whose name it is said in, as far as an address tells.
    bool IsItsOwn(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    // Against what was said before.
    Verdict Compare(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    void ReplaceNumber(const Submessage &submessage, const Delivery &delivery, const Passage &passage);
    void ReplaceAnnouncement(const Submessage &submessage, const Delivery &delivery,
                             const GuidPrefix &sender);
    void ReplaceCount(const Submessage &submessage, const Delivery &delivery, const GuidPrefix &sender);

    const Mode _mode;
    const Requests _requests;
    PeerObserver *_observer = nullptr;
    std::mutex _mutex;              // several sockets receive at once
    KnownPeers _peers;              // guarded by _mutex
    SentFragments _sent;            // guarded by _mutex
    DiscoveryFragments _fragments;  // guarded by _mutex
    AnnouncementReplies _replies;   // guarded by _mutex
    GuidPrefix _own{};              // once we have sent; guarded by _mutex
    std::atomic<bool> _replyDue{false};
    std::atomic<std::uint64_t> _announcementsHeard{0};
};

}  // namespace Rabit::Rtps
