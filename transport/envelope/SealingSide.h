#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/Ledger.h"
#include "envelope/BlobExchange.h"
#include "envelope/ClaimExchange.h"
#include "envelope/Member.h"
#include "envelope/Receiver.h"
#include "envelope/Sealer.h"
#include "envelope/Session.h"
#include "envelope/SessionPlaces.h"

namespace Rabit::Envelope
{

// Seals all datagrams of one session, in the newest epoch that the member knows, and knows which of them are
// for one other session alone. Thread-safe by a lock of its own; calls nothing. Each function puts the sealed
// datagram into `sealed`, which is empty after a fault.
class SealingSide
{
public:
    // `self` must outlive it.
    SealingSide(std::shared_ptr<const Member> member, Self &self);

    SealFault Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
                   OuterClass contents, std::vector<std::uint8_t> &sealed);
    SealFault SealClaim(const ClaimExchange::Outgoing &claim, std::vector<std::uint8_t> &sealed);
    SealFault SealBlob(const BlobExchange::Outgoing &blob, std::vector<std::uint8_t> &sealed);

    // A proven session has announced these places. Call it under the lock of opening, since it uses the
    // session and the own agreement key. `isGone`: true for sessions that have ended; asked only if there are
    // many.
    void SetPlaces(const Session &session, SessionTag tag, std::span<const Rtps::Place> places,
                   const std::function<bool(SessionTag)> &isGone);

private:
    // A proven session. The opener has an object of its own for it.
    struct Known
    {
        Session Of;
        std::optional<Receiver> To{};  // with the key of one epoch
    };

    // All require _mutex.
    void FollowEpochs();
    const Receiver *ReceiverAt(const std::optional<Rtps::Place> &to);
    const Receiver *ReceiverOf(Known &known);
    static SealFault Ended(const Sealer::Result &result, std::vector<std::uint8_t> &sealed);

    const std::shared_ptr<const Member> _member;
    const Self &_self;
    std::mutex _mutex;
    std::uint64_t _version = 0;
    EpochSecrets _epochs;
    Sealer _sealer;
    SessionPlaces _places;
    std::unordered_map<SessionTag, Known> _known;
};

}  // namespace Rabit::Envelope
